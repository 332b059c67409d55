#pragma once
#include "sim/gap/estimation/as_built.hpp"

/// How an answer about a robot as built is completed.
namespace sim::estimation {

/// What an answer is drawn from.
struct Problem {
  const erp::Robot& nominal;
  const Estimator& train;
  const ResidualVector& held_out;
  const AsBuiltOptions& options;
};

/// What nobody measures when a robot is drawn: where things are zero, and how a body's mass is spread.
bool is_never_certain(const Constant& constant);
/// All constants of the robot but those of withheld effects; `exact`: those alone that are never certain.
Uncertain uncertain_of(const erp::Robot& nominal, const std::vector<std::string>& withhold,
                       bool exact);
/// The same effects at the same places.
bool are_same(const std::vector<effects::Placed>& a, const std::vector<effects::Placed>& b);

/// Takes what was found as the answer.
void take(AsBuilt& built, const Found& found);
/// Completes an answer with its constants that are far off, less the effects that those make needless. `search` must
/// refer to `built.uncertain`.
Found complete(const Search& search, Found found, const Problem& problem, AsBuilt& built);

/// The answer itself, or one with effects and no constant far off if that costs less and they are no
/// more causes; of equivalent answers the single constant.
/// `hints`: effects that would explain most were all constants as described. Beside constants that have
/// gone along to imitate it, an effect is no longer found.
AsBuilt or_effect(const Problem& problem, AsBuilt built, const std::vector<effects::Placed>& hints);

}  // namespace sim::estimation
