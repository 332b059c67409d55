#pragma once
#include "sim/gap/diagnosis/identification.hpp"

/// What an effect promises before it is fitted, as if its law were linear.
///
///   promise = (zᵀ d⊥)²/(d⊥ᵀ d⊥)       z what is left, d what a nudge of a parameter changes
///
/// d⊥: less what the parameters of the effects that are there already could change as well, for
/// these will be fitted again beside it (orthogonal least squares: Chen, Billings, Luo 1989).
namespace sim::diagnosis {

/// Every effect of the library at every place, neutral. Where joints were found by the tendons, not
/// those that change what measured joints say; nor those of a sensor that a drive has not.
std::vector<effects::Placed> candidates(const Evaluator& evaluator,
                                        const std::vector<std::string>& withhold);

/// An effect with each of its fitted parameters in turn higher by 0.3 % and by 10 % of its bound;
/// those before it a little, for a shape shows only once there is something.
std::vector<effects::Placed> perturbations(const effects::Placed& neutral);

/// The recording with the largest residuals.
std::size_t largest_residuals_in(const Evaluator& evaluator, const Evaluation& base,
                                 std::span<const std::size_t> episodes);

/// The effects that promise most on the loudest training recording, in the order of the library:
/// `screen_share` of the best and at least `fitted_at_least`.
std::vector<effects::Placed> screen_effects(const Evaluator& evaluator, const Evaluation& base,
                                            const RankingOptions& options);

/// The `count` effects that promise most, the best first.
std::vector<effects::Placed> best_screened(const Evaluator& evaluator, const Evaluation& base,
                                           const RankingOptions& options, std::size_t count);

}  // namespace sim::diagnosis
