#include "sim/gap/diagnosis/residual_split.hpp"

#include <fmt/format.h>

namespace sim::diagnosis {
namespace {

bool are_given(const DiagnoseOptions& options) {
  return !options.train.empty() || !options.held_out.empty();
}

}  // namespace

Sets first_sets(const Problem& problem) {
  const DiagnoseOptions& options = problem.options;
  return are_given(options) ? Sets{options.train, options.held_out} : split(problem.episodes);
}

bool split_by_residual(Problem& problem, const Evaluator& evaluator, CutRecordings& cut) {
  if (are_given(problem.options)) return false;
  const auto before = problem.sets.held_out;
  problem.sets = hold_out_visible(problem.sets, evaluator, problem.localization_options());
  const auto all = cuts(problem.sets, evaluator, problem.localization_options());
  for (const Cut& one : all) {
    const residuals::Episode& episode = problem.episodes[one.episode];
    cut.split_recordings.push_back({episode.name, double(one.row) * episode.period_s});
    cut.warnings.push_back(fmt::format(
        "too few recordings show the gap in the {} of {}: effects are fitted to the first {:.1f} s "
        "of {} and evaluated on the rest; record another that shows it",
        effects::word(one.stage), one.on, cut.split_recordings.back().judged_from_s, episode.name));
    cut_in_two(one, problem.episodes, problem.sets);
  }
  return !all.empty() || problem.sets.held_out != before;
}

}  // namespace sim::diagnosis
