#pragma once
#include <vector>

#include "sim/effects/library.hpp"
#include "sim/residuals/episode.hpp"

namespace sim::gap {

/// Values of an effect to begin at, where a small step from neutral changes nothing: stops of a hinge at, or a
/// little before, where recordings saw it turn back, one of them or both. Empty for other effects.
std::vector<effects::Placed> starts(const effects::Placed& neutral, const erp::Robot& nominal,
                                    const std::vector<const residuals::Episode*>& recordings);

}  // namespace sim::gap
