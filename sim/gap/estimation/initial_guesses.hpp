#pragma once
#include <vector>

#include "sim/gap/residuals/episode.hpp"
#include "sim/model/effects/library.hpp"

namespace sim::estimation {

/// Initial guesses of an effect that the gradient at its neutral value does not lead to. For the early stop of a
/// revolute joint: either stop, or both, at the extreme angles of the recordings and up to 0.05 rad earlier. Empty for
/// all other effects. `recordings`: episodes of `nominal`, by their judged rows.
std::vector<effects::Placed> initial_guesses(
    const effects::Placed& neutral, const erp::Robot& nominal,
    const std::vector<const residuals::Episode*>& recordings);

}  // namespace sim::estimation
