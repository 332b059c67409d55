#pragma once
#include <span>

#include "sim/effects/library.hpp"
#include "sim/residuals/episode.hpp"

namespace sim::gap {

/// False: of a sensor that a drive has not; or a law that differs from a plainer one only in what no
/// recording has, as friction that is not the same both ways of a shaft that turns one way.
bool can_show(const effects::Placed& effect, const erp::Robot& robot,
              std::span<const residuals::Episode> recordings);

}  // namespace sim::gap
