#include <algorithm>
#include <cmath>
#include <span>

#include "sim/diagnosis/selection.hpp"
#include "sim/diagnosis/shape.hpp"

namespace sim::diagnosis {
namespace {

/// What an effect adds to the noise of a stage, in units of the nominal: Σ over windows of
/// (σ_now/σ)² − 1.
struct Louder {
  effects::Stage stage;
  std::string on;
  double more = 0, windows = 0;

  double excess() const { return windows > 0 ? more / windows : 0; }
};

std::vector<Louder> louder(const Evidence& evidence, const Trials& trials, const Trial& trial) {
  std::vector<Louder> all;
  for (const std::size_t e : evidence.sets.held_out) {
    const auto now = trials.floor_under(trial, e);
    const auto z = trials.whitened(trials.bare(), e);
    const auto& residuals = trials.bare().of_episode[e].residuals;
    std::size_t at = 0;
    for (std::size_t r = 0; r < residuals.size(); at += residuals[r++].value.size()) {
      auto place = find_stage(all, residuals[r].stage, residuals[r].on);
      if (place == all.end()) place = all.insert(place, {residuals[r].stage, residuals[r].on});
      const auto here = std::span(z).subspan(at, residuals[r].value.size());
      const auto windows =
          static_cast<double>(here.size()) -
          static_cast<double>(std::ranges::count_if(here, [](double x) { return std::isnan(x); }));
      const double ratio = r < now.size() && windows > 0 ? now[r] / trials.floor(e)[r] : 1;
      place->more += windows * std::max(0.0, ratio * ratio - 1), place->windows += windows;
    }
  }
  return all;
}

/// Of a stage that keeps so much excess, and such a share of what it was, nothing was explained.
constexpr double kept_excess = 1.5, kept_share = 0.25;  // chosen on development cases
/// One that keeps so much, and whose windows held out follow a map of those trained on, has a law
/// that no effect of the answer has the shape of: the effects' own simplifications follow nothing.
constexpr double bent_excess = 1, bent_share = 0.5;  // chosen on development cases

std::vector<StageGap> held_out(const Evidence& evidence, const Trials& trials, const Trial& trial) {
  return where(trials, trial, evidence.sets.held_out, evidence.where_options());
}

double most_excess(const std::vector<StageGap>& gaps) {
  double most = 0;
  for (const StageGap& gap : gaps) most = std::max(most, gap.excess);
  return most;
}

bool follows_a_variable(const Evidence& evidence, const Trials& trials, const Trial& trial,
                        const StageGap& gap) {
  const auto shape =
      shape_of(trials, trial, gap.stage, gap.on, evidence.sets.train, evidence.sets.held_out);
  return shape && shape->explained > bent_share;
}

}  // namespace

std::vector<StageGap> left_open(const Evidence& evidence, const Trials& trials, const Trial& trial,
                                const Tolerance& tolerance) {
  const auto before = held_out(evidence, trials, trials.bare());
  const double least = tolerance.of_most * most_excess(before);
  const auto noise = louder(evidence, trials, trial);
  auto gaps = held_out(evidence, trials, trial);
  for (StageGap& gap : gaps) {
    const double was = find_stage(before, gap.stage, gap.on)->excess;
    gap.excess -= find_stage(noise, gap.stage, gap.on)->excess();
    const bool too_much = gap.excess > std::max(tolerance.excess, tolerance.share * was);
    const bool as_it_was = gap.excess > std::max(kept_excess, kept_share * was);
    gap.open = gap.open && gap.excess > least && (too_much || as_it_was);
  }
  return gaps;
}

void open_what_is_bent(const Evidence& evidence, const Trials& trials, const Trial& trial,
                       const Tolerance& tolerance, std::vector<StageGap>& gaps) {
  const double most = most_excess(held_out(evidence, trials, trials.bare()));
  for (StageGap& gap : gaps)
    if (!gap.open && gap.judged && gap.excess > std::max(bent_excess, tolerance.of_most * most))
      gap.open = follows_a_variable(evidence, trials, trial, gap);
}

}  // namespace sim::diagnosis
