#pragma once
#include "sim/gap/diagnosis/which.hpp"

/// What an effect promises before it is fitted, as if its law were linear.
///
///   promise = (zᵀ d⊥)²/(d⊥ᵀ d⊥)       z what is left, d what a nudge of a parameter changes
///
/// d⊥: less what the parameters of the effects that are there already could change as well, for
/// these will be fitted again beside it (orthogonal least squares: Chen, Billings, Luo 1989).
namespace sim::diagnosis {

/// Every effect of the library at every place, neutral. Where joints were found by the tendons, not
/// those that change what measured joints say; nor those of a sensor that a drive has not.
std::vector<effects::Placed> candidates(const Trials& trials,
                                        const std::vector<std::string>& withhold);

/// An effect with each of its fitted parameters in turn higher by 0.3 % and by 10 % of its bound;
/// those before it a little, for a shape shows only once there is something.
std::vector<effects::Placed> nudges(const effects::Placed& neutral);

/// The recording with the largest residuals.
std::size_t loudest(const Trials& trials, const Trial& base, std::span<const std::size_t> episodes);

/// The effects that promise most on the loudest training recording, in the order of the library:
/// `look_share` of the best and at least `fitted_at_least`.
std::vector<effects::Placed> promising(const Trials& trials, const Trial& base,
                                       const WhichOptions& options);

/// The `count` effects that promise most, the best first.
std::vector<effects::Placed> most_promising(const Trials& trials, const Trial& base,
                                            const WhichOptions& options, std::size_t count);

}  // namespace sim::diagnosis
