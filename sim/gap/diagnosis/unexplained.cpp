#include <algorithm>
#include <cmath>
#include <span>

#include "sim/gap/diagnosis/residual_profile.hpp"
#include "sim/gap/diagnosis/selection.hpp"

namespace sim::diagnosis {
namespace {

/// Increase of the noise of a stage by effects, in units of the nominal noise: Σ over windows of
/// (σ_effects/σ)² − 1.
struct NoiseIncrease {
  effects::Stage stage;
  std::string on;
  double sum = 0, windows = 0;

  double excess() const { return windows > 0 ? sum / windows : 0; }
};

std::vector<NoiseIncrease> noise_increases(const Problem& problem, const Evaluator& evaluator,
                                           const Evaluation& evaluation) {
  std::vector<NoiseIncrease> all;
  for (const std::size_t e : problem.sets.held_out) {
    const auto floors = evaluator.floor_under(evaluation, e);
    const auto z = evaluator.whitened(evaluator.nominal_evaluation(), e);
    const auto& residuals = evaluator.nominal_evaluation().of_episode[e].residuals;
    std::size_t at = 0;
    for (std::size_t r = 0; r < residuals.size(); at += residuals[r++].value.size()) {
      auto place = find_stage(all, residuals[r].stage, residuals[r].on);
      if (place == all.end()) place = all.insert(place, {residuals[r].stage, residuals[r].on});
      const auto stage_z = std::span(z).subspan(at, residuals[r].value.size());
      const auto windows = static_cast<double>(stage_z.size()) -
                           static_cast<double>(std::ranges::count_if(
                               stage_z, [](double x) { return std::isnan(x); }));
      const double ratio =
          r < floors.size() && windows > 0 ? floors[r].rms / evaluator.floor(e, r) : 1;
      place->sum += windows * std::max(0.0, ratio * ratio - 1), place->windows += windows;
    }
  }
  return all;
}

/// Further criteria of an open stage, chosen on development cases: a quarter of its nominal excess
/// remains; or at least half of the remaining residual is a function of one variable, which means
/// that its law differs from the answer's.
constexpr double quarter_excess = 1.5, quarter = 0.25;
constexpr double profile_excess = 1, profile_share = 0.5;

std::vector<StageGap> held_out(const Problem& problem, const Evaluator& evaluator,
                               const Evaluation& evaluation) {
  return localize(evaluator, evaluation, problem.sets.held_out, problem.localization_options());
}

}  // namespace

bool stays_open(double excess, double before, const Tolerance& tolerance,
                const std::function<double()>& explained_by_one_variable) {
  return excess > std::max(tolerance.excess, tolerance.share * before) ||
         excess > std::max(quarter_excess, quarter * before) ||
         (excess > profile_excess && explained_by_one_variable() > profile_share);
}

std::vector<StageGap> unexplained_stages(const Problem& problem, const Evaluator& evaluator,
                                         const Evaluation& evaluation, const Tolerance& tolerance) {
  const auto before = held_out(problem, evaluator, evaluator.nominal_evaluation());
  double largest = 0;
  for (const StageGap& b : before) largest = std::max(largest, b.excess);
  const auto noise = noise_increases(problem, evaluator, evaluation);
  auto gaps = held_out(problem, evaluator, evaluation);
  for (StageGap& gap : gaps) {
    const double nominal = find_stage(before, gap.stage, gap.on)->excess;
    gap.excess -= find_stage(noise, gap.stage, gap.on)->excess();
    if (!gap.open || gap.excess <= tolerance.of_largest * largest) {
      gap.open = false;
      continue;
    }
    gap.open = stays_open(gap.excess, nominal, tolerance, [&] {
      return explained_by_one_variable(evaluator, evaluation, gap.stage, gap.on, problem.sets);
    });
  }
  return gaps;
}

}  // namespace sim::diagnosis
