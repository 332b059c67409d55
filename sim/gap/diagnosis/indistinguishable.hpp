#pragma once
#include <vector>

#include "sim/gap/diagnosis/evaluation.hpp"

/// Effects that recordings cannot distinguish, whatever their sizes.
///
///   remaining = |δz − P δz|      δz: change of the residuals by a small effect, in units of noise
///                                P: projection onto the changes by the parameters of another effect
///
/// `remaining` is the number of standard deviations by which the two effects differ. Laws are
/// linearized; differences in the form of the laws are visible only in a fit. Ignores further
/// parameters of the effect, and laws with a threshold above 10 % of their range.
namespace sim::diagnosis {

struct Indistinguishable {
  effects::Placed hidden;  ///< at 0.3 % of its range, or at 10 % if that is not visible
  std::vector<effects::Placed> others;  ///< one effect, or several (confounders.hpp)
  double magnitude = 0;                 ///< |δz| of `hidden`
  double remaining = 0;                 ///< |δz − P δz|
};

/// Returns the pairs with remaining ≤ share · magnitude, exact matches first. Types in `withhold`
/// are omitted. Effects on the bus and quantization change no residual and are not listed.
std::vector<Indistinguishable> indistinguishable_effects(
    const Evaluator& evaluator, double share, const std::vector<std::string>& withhold = {},
    int threads = 2);

}  // namespace sim::diagnosis
