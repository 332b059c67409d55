#include <cmath>

#include "sim/gap/diagnosis/gap_closure.hpp"

namespace sim::diagnosis {
namespace {

/// The window with the largest residual. Empty if all are NaN.
std::optional<std::size_t> peak_of(const std::vector<double>& residual) {
  std::optional<std::size_t> peak;
  for (std::size_t k = 0; k < residual.size(); ++k)
    if (!std::isnan(residual[k]) && (!peak || std::abs(residual[k]) > std::abs(residual[*peak])))
      peak = k;
  return peak;
}

/// Copies 2.5 s on both sides of the peak of residual `r` of recording `e`.
void copy_around(const Problem& problem, const Evaluator& plain, const Evaluation& evaluation,
                 std::size_t e, std::size_t r, std::size_t peak, WorstWindow& into) {
  constexpr std::size_t around = 125;  // windows
  const residuals::Explanation& bare = plain.bare().of_episode[e];
  const auto& before = bare.residuals[r].value;
  const auto& after = evaluation.of_episode[e].residuals[r].value;
  into.recording = problem.episodes[e].name, into.floor = plain.floor(e, r);
  into.time_s.clear(), into.before.clear(), into.after.clear();
  for (std::size_t k = peak < around ? 0 : peak - around;
       k < std::min(before.size(), peak + around); ++k) {
    into.time_s.push_back(double(bare.rows[k]) * problem.episodes[e].period_s);
    into.before.push_back(before[k]), into.after.push_back(after[k]);
  }
}

}  // namespace

std::vector<WorstWindow> worst_windows(const Problem& problem, const Evaluator& plain,
                                       const Evaluation& evaluation,
                                       const std::vector<StageGap>& stages) {
  constexpr std::size_t most = 3;
  std::vector<WorstWindow> all;
  for (const StageGap& gap : stages) {
    if (!gap.open || all.size() == most) continue;
    WorstWindow worst{gap.stage, gap.on, gap.unit, "", 0, {}, {}, {}};
    double largest = -1;
    for (const std::size_t e : problem.sets.held_out) {
      const auto& residuals = plain.bare().of_episode[e].residuals;
      const auto at = find_stage(residuals, gap.stage, gap.on);
      if (at == residuals.end()) continue;
      const auto peak = peak_of(at->value);
      if (!peak || std::abs(at->value[*peak]) <= largest) continue;
      largest = std::abs(at->value[*peak]);
      copy_around(problem, plain, evaluation, e, std::size_t(at - residuals.begin()), *peak, worst);
    }
    all.push_back(std::move(worst));
  }
  return all;
}

}  // namespace sim::diagnosis
