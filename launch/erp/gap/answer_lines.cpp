#include "launch/erp/gap/answer_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "launch/erp/gap/messages.hpp"

namespace launch::gap {
namespace {

namespace diagnosis = sim::diagnosis;

std::string text_of(const diagnosis::IdentifiedEffect& n) {
  std::string text = fmt::format("{} on {}", n.type, n.on);
  for (std::size_t k = 0; k < n.names.size(); ++k)
    text += fmt::format("  {} = {:.4g} ({:.4g} to {:.4g})", n.names[k], n.values[k],
                        n.intervals[k].low, n.intervals[k].high);
  return text + fixed_parameters(n);
}

/// Places with equal shares cannot be distinguished.
void print_location(const diagnosis::Diagnosis& d, std::ostream& out) {
  for (std::size_t k = 0; k < d.where.size();) {
    const double share = d.where[k].share;
    std::string names;
    double sum = 0;
    for (; k < d.where.size() && d.where[k].share == share; ++k, sum += share)
      names += fmt::format("{}{} of {}", names.empty() ? "" : ", or ",
                           sim::effects::word(d.where[k].stage), d.where[k].on);
    if (share > 0) out << fmt::format("location    {}: {} of the gap\n", names, share_text(sum));
    else out << fmt::format("location    {}; it changes no residual\n", names);
  }
}

/// Prints how many constants the recordings determine, and those that deviate from their nominal values.
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

/// Whether constants explain the gap, without an effect and each within its tolerance.
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
  for (const auto& n : d.answer) {
    out << label << text_of(n) << "\n";
    constexpr std::size_t shown = 4;
    for (std::size_t k = 0; k < std::min(shown, n.alternatives.size()); ++k)
      out << "equivalent  " << text_of(n.alternatives[k]) << "\n";
    if (n.alternatives.size() > shown)
      out << fmt::format("equivalent  {} more, listed in diagnosis.json\n",
                         n.alternatives.size() - shown);
  }
  for (const auto& u : d.unexplained) {
    out << fmt::format("unexplained {} of {}: residual {:.3g} times its noise",
                       sim::effects::word(u.stage), u.on, std::sqrt(1 + u.excess));
    if (u.shape && u.shape->constant > 0.1)
      out << fmt::format("; {:.0f} % of it is constant", 100 * u.shape->constant);
    if (u.shape && u.shape->explained - u.shape->constant > 0.1)
      out << fmt::format("; {:.0f} % of it depends on the {}",
                         100 * (u.shape->explained - u.shape->constant), u.shape->variable);
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

/// Whether a motion can show the effect. Effects of the bus change no residual.
bool can_be_excited(const diagnosis::IdentifiedEffect& n) {
  return sim::effects::about(n.placed.effect).stage != sim::effects::Stage::bus;
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
  const bool unique =
      std::ranges::all_of(d.answer, [](const auto& n) { return n.alternatives.empty(); });
  const bool done = d.verdict == diagnosis::Verdict::no_gap ||
                    (d.verdict == diagnosis::Verdict::supported && unique);
  const bool any = std::ranges::any_of(d.ranked, can_be_excited);
  if (done || !any || !d.fix_first.empty() || !robot.drives.empty()) return;
  out << fmt::format(
      "next        erp gap plan --robot {} --diagnosis {}/diagnosis.json --out {}/next\n",
      options.robot, options.out, options.out);
}

}  // namespace launch::gap
