#include <algorithm>

#include "sim/diagnosis/selection.hpp"

namespace sim::diagnosis {

std::vector<StageGap> left_open(const Evidence& evidence, const Trials& trials, const Trial& trial,
                                const Tolerance& tolerance) {
  const auto of = [&](const Trial& t) {
    return where(trials, t, evidence.sets.held_out, evidence.where_options());
  };
  const auto before = of(trials.bare());
  double most = 0;
  for (const StageGap& b : before) most = std::max(most, b.excess);
  auto gaps = of(trial);
  for (StageGap& gap : gaps) {
    const double was = find_stage(before, gap.stage, gap.on)->excess;
    gap.open = gap.open && gap.excess > std::max({tolerance.excess, tolerance.share * was,
                                                  tolerance.of_most * most});
  }
  return gaps;
}

}  // namespace sim::diagnosis
