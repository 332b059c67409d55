#pragma once
#include <span>

#include "sim/gap/residuals/episode.hpp"
#include "sim/model/effects/library.hpp"

namespace sim::estimation {

/// False if the drive lacks the sensor, or if no recording excites what distinguishes the law from a simpler one, such
/// as both directions of a shaft for friction that differs with the direction.
bool is_observable(const effects::Placed& effect, const erp::Robot& robot,
                   std::span<const residuals::Episode> recordings);

}  // namespace sim::estimation
