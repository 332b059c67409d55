#pragma once
#include "sim/gap/diagnosis/identification.hpp"

/// Screening: the reduction of Σ z² that a fit of an effect can reach, estimated with a linearized
/// law.
///
///   score = (zᵀ d⊥)²/(d⊥ᵀ d⊥)       z: remaining residuals, d: their change by a parameter step
///
/// d⊥: component of d orthogonal to the changes by the parameters of the chosen effects, because
/// these are fitted again jointly with the new effect (orthogonal least squares: Chen, Billings,
/// Luo 1989).
namespace sim::diagnosis {

/// Returns every effect of the library at every place, with neutral values. Effects on joint angles
/// are omitted if these were estimated from tendons. Effects on sensors that a drive lacks are
/// omitted.
std::vector<effects::Placed> candidates(const Evaluator& evaluator,
                                        const std::vector<std::string>& withhold);

/// Returns an effect with each of its fitted parameters in turn increased by 0.3 % and by 10 % of
/// its bound. The parameters before it are increased by 0.3 %, because a form parameter has no
/// effect at size 0.
std::vector<effects::Placed> perturbations(const effects::Placed& neutral);

/// The recording with the largest residuals.
std::size_t largest_residuals_in(const Evaluator& evaluator, const Evaluation& base,
                                 std::span<const std::size_t> episodes);

/// The effects with the best scores on the training recording with the largest residuals, in the
/// order of the library: all above `screen_share` of the best score, and at least
/// `fitted_at_least`.
std::vector<effects::Placed> screen_effects(const Evaluator& evaluator, const Evaluation& base,
                                            const RankingOptions& options);

/// The `count` effects with the best scores, best first.
std::vector<effects::Placed> best_screened(const Evaluator& evaluator, const Evaluation& base,
                                           const RankingOptions& options, std::size_t count);

}  // namespace sim::diagnosis
