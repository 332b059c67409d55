#pragma once
#include <vector>

#include "sim/gap/residuals/episode.hpp"
#include "sim/model/effects/library.hpp"

namespace sim::estimation {

/// Returns initial guesses of an effect that a gradient descent from its neutral value does not
/// find. For the early stop of a revolute joint: one stop or both, at the extreme angles of the
/// recordings or up to 0.05 rad before. Empty for all other effects. `recordings`: episodes of
/// `nominal`; only their judged rows are used.
std::vector<effects::Placed> initial_guesses(
    const effects::Placed& neutral, const erp::Robot& nominal,
    const std::vector<const residuals::Episode*>& recordings);

}  // namespace sim::estimation
