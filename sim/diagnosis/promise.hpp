#pragma once
#include "sim/diagnosis/which.hpp"

/// What an effect promises before it is fitted, as if its law were linear.
///
///   promise = (zᵀ d⊥)²/(d⊥ᵀ d⊥)       z what is left, d what a nudge of a parameter changes
///
/// d⊥: less what the parameters of the effects that are there already could change as well, for
/// these will be fitted again beside it (orthogonal least squares: Chen, Billings, Luo 1989).
namespace sim::diagnosis {

/// The effects that promise most on the loudest training recording, in the order of the library:
/// `look_share` of the best and at least `fitted_at_least`.
std::vector<effects::Placed> promising(const Trials& trials, const Trial& base,
                                       const WhichOptions& options);

/// The `count` effects that promise most, the best first.
std::vector<effects::Placed> most_promising(const Trials& trials, const Trial& base,
                                            const WhichOptions& options, std::size_t count);

}  // namespace sim::diagnosis
