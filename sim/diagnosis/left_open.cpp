#include <algorithm>

#include "sim/diagnosis/selection.hpp"

namespace sim::diagnosis {
namespace {

/// How much more noise there is under a trial at each stage of the recordings held out, as a ratio
/// of squares; never less than 1.
struct Louder {
  effects::Stage stage;
  std::string on;
  double now = 0, nominal = 0;  ///< Σ σ²
};

std::vector<Louder> louder(const Evidence& evidence, const Trials& trials, const Trial& trial) {
  std::vector<Louder> all;
  for (const std::size_t e : evidence.sets.held_out) {
    const auto now = trials.floor_under(trial, e);
    const auto& residuals = trials.bare().of_episode[e].residuals;
    for (std::size_t r = 0; r < residuals.size(); ++r) {
      auto place = find_stage(all, residuals[r].stage, residuals[r].on);
      if (place == all.end()) place = all.insert(place, {residuals[r].stage, residuals[r].on});
      const double nominal = trials.floor(e)[r];
      place->nominal += nominal * nominal;
      const double floor = r < now.size() ? std::max(now[r], nominal) : nominal;
      place->now += floor * floor;
    }
  }
  return all;
}

}  // namespace

std::vector<StageGap> left_open(const Evidence& evidence, const Trials& trials, const Trial& trial,
                                const Tolerance& tolerance) {
  const auto of = [&](const Trial& t) {
    return where(trials, t, evidence.sets.held_out, evidence.where_options());
  };
  const auto before = of(trials.bare());
  double most = 0;
  for (const StageGap& b : before) most = std::max(most, b.excess);
  const auto noise = louder(evidence, trials, trial);
  auto gaps = of(trial);
  for (StageGap& gap : gaps) {
    const double was = find_stage(before, gap.stage, gap.on)->excess;
    if (const auto n = find_stage(noise, gap.stage, gap.on); n->nominal > 0)
      gap.excess = (1 + gap.excess) * n->nominal / n->now - 1;
    gap.open = gap.open && gap.excess > std::max({tolerance.excess, tolerance.share * was,
                                                  tolerance.of_most * most});
  }
  return gaps;
}

}  // namespace sim::diagnosis
