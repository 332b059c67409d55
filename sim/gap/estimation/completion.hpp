#pragma once
#include "sim/gap/estimation/as_built.hpp"

/// Completes an answer about a robot as built.
namespace sim::estimation {

/// The inputs of an answer.
struct Problem {
  const erp::Robot& nominal;
  const Estimator& train;
  const ResidualVector& held_out;
  const AsBuiltOptions& options;
};

/// Whether a constant is never measured when a robot is designed: a zero, or the mass distribution of a body.
bool is_never_certain(const Constant& constant);
/// All constants of the robot except those of withheld effects; `exact`: only those that are never certain.
Uncertain uncertain_of(const erp::Robot& nominal, const std::vector<std::string>& withhold,
                       bool exact);
/// Whether both lists have the same effects at the same places.
bool are_same(const std::vector<effects::Placed>& a, const std::vector<effects::Placed>& b);

/// Sets the answer from `found`.
void take(AsBuilt& built, const Found& found);
/// Completes an answer with its constants that are far off, and removes the effects that these make unnecessary.
/// `search` must refer to `built.uncertain`.
Found complete(const Search& search, Found found, const Problem& problem, AsBuilt& built);

/// Returns the answer itself, or one with effects and no constant far off if that costs less and has no more causes. If
/// both are equivalent, the single constant.
/// `hints`: effects that would explain most if all constants were as described. Beside constants that have moved to
/// imitate an effect, the search does not find it.
AsBuilt or_effect(const Problem& problem, AsBuilt built, const std::vector<effects::Placed>& hints);

}  // namespace sim::estimation
