#pragma once
#include <vector>

#include "sim/gap/diagnosis/evaluation.hpp"

/// Which effects recordings cannot tell apart, whatever their sizes.
///
///   left = |δz − P δz|      δz: what a small effect changes, in units of noise
///                           P: projects onto what the parameters of another change
///
/// is how many standard deviations remain of the one where the other stands for it, as if laws were
/// linear. What a change of the law's shape would tell, a fit tells. Ignores: further parameters of
/// what is hidden, and laws with a threshold that 10 % of their range does not pass.
namespace sim::diagnosis {

struct Indistinguishable {
  effects::Placed hidden;  ///< 0.3 % of the range, or 10 % where that does not show
  std::vector<effects::Placed>
      others;        ///< one; of `confounders` several, who stand for it together
  double shows = 0;  ///< |δz| of what is hidden
  double left = 0;   ///< of it, once the others stand for it
};

/// Those of which at most `share` is left, the exact ones first. Types withheld are not looked at.
/// Bus and coarse steps, which change no residual, are in none.
std::vector<Indistinguishable> indistinguishable_effects(
    const Evaluator& evaluator, double share, const std::vector<std::string>& withhold = {},
    int threads = 2);

}  // namespace sim::diagnosis
