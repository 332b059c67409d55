#include "sim/gap/diagnosis/isolation.hpp"

#include <algorithm>
#include <cmath>

#include "interfaces/parallel/in_parallel.hpp"
#include "sim/gap/diagnosis/initial_guesses.hpp"
#include "sim/gap/diagnosis/screening.hpp"

namespace sim::diagnosis {
namespace {

using effects::Placed;

// Tolerances of scaled signatures, because laws are not linear; chosen.
constexpr double least_share = 0.05;        // of the largest excess; less may have another cause
constexpr double max_underestimation = 10;  // factor, of an open stage
constexpr double max_closed_excess = 10;    // of a stage that is not open

/// Mean Δz² by stage.
std::vector<double> signature(const Evaluator& evaluator, const Placed& perturbed,
                              std::size_t episode) {
  const std::size_t only[] = {episode};
  const Evaluation with = evaluator.with(evaluator.nominal_evaluation(), perturbed, only);
  const auto before = evaluator.whitened(evaluator.nominal_evaluation(), episode),
             after = evaluator.whitened(with, episode);
  std::vector<double> means;
  std::size_t at = 0;
  for (const residuals::Residual& r :
       evaluator.nominal_evaluation().of_episode[episode].residuals) {
    double square = 0, windows = 0;
    for (std::size_t k = 0; k < r.value.size(); ++k, ++at)
      if (!std::isnan(before[at])) square += std::pow(after[at] - before[at], 2), ++windows;
    means.push_back(windows > 0 ? square / windows : 0);
  }
  return means;
}

/// The gaps in the order of the residuals.
std::vector<StageGap> gap_of(const Evaluator& evaluator, std::size_t episode,
                             const Problem& problem) {
  const std::size_t only[] = {episode};
  const auto gaps =
      localize(evaluator, evaluator.nominal_evaluation(), only, problem.localization_options());
  std::vector<StageGap> ordered;
  for (const residuals::Residual& r : evaluator.nominal_evaluation().of_episode[episode].residuals)
    ordered.push_back(*find_stage(gaps, r.stage, r.on));
  return ordered;
}

/// Whether a scaled signature explains the gap.
bool explains(const std::vector<StageGap>& gap, const std::vector<double>& signature) {
  const auto largest = std::ranges::max_element(gap, {}, &StageGap::share);
  const double largest_signature = signature[std::size_t(largest - gap.begin())];
  if (!(largest_signature > 0) || !largest->open) return false;
  const double factor = largest->excess / largest_signature;
  for (std::size_t r = 0; r < gap.size(); ++r) {
    const double expected = factor * signature[r];
    if (gap[r].open && gap[r].excess > least_share * largest->excess &&
        expected * max_underestimation < gap[r].excess)
      return false;
    if (gap[r].judged && !gap[r].open && expected > max_closed_excess) return false;
  }
  return true;
}

}  // namespace

std::vector<Part> isolate(const Problem& problem, const Evaluator& evaluator) {
  const std::size_t episode =
      largest_residuals_in(evaluator, evaluator.nominal_evaluation(), problem.sets.train);
  const auto gap = gap_of(evaluator, episode, problem);
  const auto all = candidates(evaluator, problem.options.withhold);
  std::vector<char> possible(all.size());
  in_parallel(all.size(), problem.options.threads, [&](std::size_t k) {
    const std::size_t only[] = {episode};
    auto variants = perturbations(all[k]);
    const auto guesses = initial_guesses(evaluator, all[k], only);
    variants.insert(variants.end(), guesses.begin(), guesses.end());
    possible[k] = std::ranges::any_of(variants, [&](const Placed& perturbed) {
      return explains(gap, signature(evaluator, perturbed, episode));
    });
  });
  std::vector<Part> parts;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (const auto stage = effects::about(all[k].effect).stage;
        possible[k] && find_stage(parts, stage, all[k].on) == parts.end())
      parts.push_back({stage, all[k].on});
  return parts;
}

}  // namespace sim::diagnosis
