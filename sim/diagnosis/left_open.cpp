#include <algorithm>

#include "sim/diagnosis/selection.hpp"

namespace sim::diagnosis {

std::vector<StageGap> left_open(const Evidence& evidence, const Trials& trials, const Trial& trial,
                                bool alone) {
  const DiagnoseOptions& o = evidence.options;
  const auto of = [&](const Trial& t) {
    return where(trials, t, evidence.sets.held_out, evidence.where_options());
  };
  const auto before = of(trials.bare());
  double most = 0;
  for (const StageGap& b : before) most = std::max(most, b.excess);
  auto gaps = of(trial);
  for (StageGap& gap : gaps) {
    const double was = find_stage(before, gap.stage, gap.on)->excess;
    const double share = alone ? o.single_left_share : o.left_share;
    const double least = alone ? o.left_excess : o.search_excess;
    const double of_most = alone ? o.single_left_of_most * most : 0;
    gap.open = gap.open && gap.excess > std::max({least, share * was, of_most});
  }
  return gaps;
}

}  // namespace sim::diagnosis
