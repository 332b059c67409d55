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

/// Copies the residual `r` of recording `e` around its peak.
void copy_around(const Problem& problem, const Evaluator& baseline, const Evaluation& evaluation,
                 std::size_t e, std::size_t r, std::size_t peak, WorstWindow& worst) {
  constexpr std::size_t reach = 125;  // windows on each side: 2.5 s; chosen
  const residuals::Explanation& nominal_evaluation = baseline.nominal_evaluation().of_episode[e];
  const auto& before = nominal_evaluation.residuals[r].value;
  const auto& after = evaluation.of_episode[e].residuals[r].value;
  worst.recording = problem.episodes[e].name, worst.floor = baseline.floor(e, r);
  worst.time_s.clear(), worst.before.clear(), worst.after.clear();
  for (std::size_t k = peak < reach ? 0 : peak - reach; k < std::min(before.size(), peak + reach);
       ++k) {
    worst.time_s.push_back(double(nominal_evaluation.rows[k]) * problem.episodes[e].period_s);
    worst.before.push_back(before[k]), worst.after.push_back(after[k]);
  }
}

}  // namespace

std::vector<WorstWindow> worst_windows(const Problem& problem, const Evaluator& baseline,
                                       const Evaluation& evaluation,
                                       const std::vector<StageGap>& stages) {
  constexpr std::size_t max_stages = 3;  // chosen
  std::vector<WorstWindow> all;
  for (const StageGap& gap : stages) {
    if (!gap.open || all.size() == max_stages) continue;
    WorstWindow worst{gap.stage, gap.on, gap.unit, "", 0, {}, {}, {}};
    double largest = -1;
    for (const std::size_t e : problem.sets.held_out) {
      const auto& residuals = baseline.nominal_evaluation().of_episode[e].residuals;
      const auto at = find_stage(residuals, gap.stage, gap.on);
      if (at == residuals.end()) continue;
      const auto peak = peak_of(at->value);
      if (!peak || std::abs(at->value[*peak]) <= largest) continue;
      largest = std::abs(at->value[*peak]);
      copy_around(problem, baseline, evaluation, e, std::size_t(at - residuals.begin()), *peak,
                  worst);
    }
    all.push_back(std::move(worst));
  }
  return all;
}

}  // namespace sim::diagnosis
