#include "launch/erp/gap/answer_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "launch/erp/gap/messages.hpp"

namespace launch::gap {
namespace {

namespace diagnosis = sim::diagnosis;

std::string text_of(const diagnosis::IdentifiedEffect& effect) {
  std::string text = fmt::format("{} on {}", effect.type, effect.on);
  for (std::size_t k = 0; k < effect.names.size(); ++k)
    text += fmt::format("  {} = {:.4g} ({:.4g} to {:.4g})", effect.names[k], effect.values[k],
                        effect.intervals[k].low, effect.intervals[k].high);
  return text + fixed_parameters(effect);
}

/// Prints the stages with a share of the gap. Stages with equal shares form a group: the sensors do
/// not distinguish them.
void print_location(const diagnosis::Diagnosis& d, std::ostream& out) {
  for (std::size_t k = 0; k < d.where.size();) {
    const double share = d.where[k].share;
    std::string names;
    double group_share = 0;
    for (; k < d.where.size() && d.where[k].share == share; ++k, group_share += share)
      names += fmt::format("{}{} of {}", names.empty() ? "" : ", or ",
                           sim::effects::word(d.where[k].stage), d.where[k].on);
    if (share > 0)
      out << fmt::format("location    {}: {} of the gap\n", names, share_text(group_share));
    else out << fmt::format("location    {}; it changes no residual\n", names);
  }
}

/// Prints how many constants the recordings determine, and the constants that deviate from their
/// nominal values.
void print_constants(const diagnosis::Diagnosis& d, std::ostream& out) {
  if (d.constants.empty()) return;
  std::size_t determined = 0;
  for (const auto& c : d.constants)
    determined += c.determined > sim::estimation::determined_threshold;
  out << fmt::format(
      "constants   the recordings determine {} of {}; {} are beyond their tolerances\n", determined,
      d.constants.size(), std::ranges::count_if(d.constants, &diagnosis::ConstantEstimate::beyond));
  for (const auto& c : d.constants)
    if (deviates(c))
      out << fmt::format("            {} {} = {:.4g} ({:.4g} to {:.4g}), nominal {:.4g}\n", c.on,
                         c.name, c.value, c.interval.low, c.interval.high, c.nominal);
}

/// Whether constants explain the gap, each within its tolerance, without any effect.
bool explained_within_tolerance(const diagnosis::Diagnosis& d) {
  return d.verdict == diagnosis::Verdict::supported && d.answer.empty() && d.as_built;
}

void print_causes(const diagnosis::Diagnosis& d, std::ostream& out) {
  print_location(d, out);
  const char* label = d.verdict == diagnosis::Verdict::supported          ? "cause       "
                      : d.verdict == diagnosis::Verdict::not_identifiable ? "candidate   "
                                                                          : "partial     ";
  if (explained_within_tolerance(d))
    out << "cause       several constants together, each within its tolerance\n";
  for (const auto& effect : d.answer) {
    out << label << text_of(effect) << "\n";
    constexpr std::size_t max_alternatives = 4;
    for (std::size_t k = 0; k < std::min(max_alternatives, effect.alternatives.size()); ++k)
      out << "equivalent  " << text_of(effect.alternatives[k]) << "\n";
    if (effect.alternatives.size() > max_alternatives)
      out << fmt::format("equivalent  {} more, listed in diagnosis.json\n",
                         effect.alternatives.size() - max_alternatives);
  }
  for (const auto& stage_gap : d.unexplained) {
    out << fmt::format("unexplained {} of {}: residual {:.3g} times its noise",
                       sim::effects::word(stage_gap.stage), stage_gap.on,
                       std::sqrt(1 + stage_gap.excess));
    constexpr double min_reported = 0.1;  // fraction of the residual; chosen
    if (stage_gap.shape && stage_gap.shape->constant > min_reported)
      out << fmt::format("; {:.0f} % of it is constant", 100 * stage_gap.shape->constant);
    if (stage_gap.shape && stage_gap.shape->explained - stage_gap.shape->constant > min_reported)
      out << fmt::format("; {:.0f} % of it depends on the {}",
                         100 * (stage_gap.shape->explained - stage_gap.shape->constant),
                         stage_gap.shape->variable);
    out << "\n";
  }
  print_constants(d, out);
  if (d.overall.before > 0 && (!d.answer.empty() || d.as_built))
    out << fmt::format(
        "gap closure residual {:.3g} times the noise before, {:.3g} after: {}, on {}\n",
        d.overall.before, d.overall.after, closure_text(d.overall), validation_data(d));
  for (const auto& c : d.channels)
    if (c.has_gap() && c.driven_by > 0 && (!d.answer.empty() || d.as_built))
      out << fmt::format(
          "            {}: residual {:.3g} % of the stage's input before, {:.3g} % after\n",
          c.channel, 100 * c.before / c.driven_by, 100 * c.after / c.driven_by);
}

/// Whether a motion can reveal the effect. Effects of the bus change no residual.
bool can_be_excited(const diagnosis::IdentifiedEffect& effect) {
  return sim::effects::about(effect.placed.effect).stage != sim::effects::Stage::bus;
}

}  // namespace

void print_answer(const diagnosis::Diagnosis& d, const sim::closed_loop::FreeRun& free_run,
                  std::ostream& out) {
  print_causes(d, out);
  if (!free_run.channels.empty() && d.answer.empty() && !d.as_built)
    out << fmt::format("free run    error {:.3g} times the noise\n", free_run.all.before);
  else if (!free_run.channels.empty())
    out << fmt::format("free run    error {:.3g} times the noise before, {:.3g} after: {}\n",
                       free_run.all.before, free_run.all.after, closure_text(free_run.all));
  for (const std::string& warning : d.warnings) out << "warning     " << warning << "\n";
  for (const std::string& fault : d.fix_first) out << "fix the recording first: " << fault << "\n";
  out << "verdict     " << diagnosis::word(d.verdict);
  if (d.verdict == diagnosis::Verdict::no_gap && !d.not_evaluated.empty())
    out << " in the evaluated stages";
  if (!d.fix_first.empty()) out << "; unreliable until the recordings are fixed";
  out << "\n";
}

void print_next(const diagnosis::Diagnosis& d, const erp::Robot& robot,
                const DiagnoseOptions& options, std::ostream& out) {
  const bool is_unique =
      std::ranges::all_of(d.answer, [](const auto& effect) { return effect.alternatives.empty(); });
  const bool is_explained = d.verdict == diagnosis::Verdict::no_gap ||
                            (d.verdict == diagnosis::Verdict::supported && is_unique);
  const bool has_excitable_effect = std::ranges::any_of(d.ranked, can_be_excited);
  if (is_explained || !has_excitable_effect || !d.fix_first.empty() || !robot.drives.empty())
    return;
  out << fmt::format(
      "next        erp gap plan --robot {} --diagnosis {}/diagnosis.json --out {}/next\n",
      options.robot, options.out, options.out);
}

}  // namespace launch::gap
