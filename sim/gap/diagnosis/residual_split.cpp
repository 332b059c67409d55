#include "sim/gap/diagnosis/residual_split.hpp"

#include <fmt/format.h>

namespace sim::diagnosis {
namespace {

bool are_given(const DiagnoseOptions& options) {
  return !options.train.empty() || !options.held_out.empty();
}

}  // namespace

Sets first_sets(const Evidence& evidence) {
  const DiagnoseOptions& options = evidence.options;
  return are_given(options) ? Sets{options.train, options.held_out} : split(evidence.episodes);
}

bool split_by_residual(Evidence& evidence, const Trials& by, CutRecordings& cut) {
  if (are_given(evidence.options)) return false;
  const auto before = evidence.sets.held_out;
  evidence.sets = hold_out_what_shows(evidence.sets, by, evidence.where_options());
  const auto all = cuts(evidence.sets, by, evidence.where_options());
  for (const Cut& one : all) {
    const residuals::Episode& episode = evidence.episodes[one.episode];
    cut.shared.push_back({episode.name, double(one.row) * episode.period_s});
    cut.warnings.push_back(fmt::format(
        "too few recordings show the gap in the {} of {}: effects are chosen on the first {:.1f} s "
        "of {} and judged on the rest; record another that shows it",
        effects::word(one.stage), one.on, cut.shared.back().judged_from_s, episode.name));
    cut_in_two(one, evidence.episodes, evidence.sets);
  }
  return !all.empty() || evidence.sets.held_out != before;
}

}  // namespace sim::diagnosis
