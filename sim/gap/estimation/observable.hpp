#pragma once
#include <span>

#include "sim/gap/residuals/episode.hpp"
#include "sim/model/effects/library.hpp"

namespace sim::estimation {

/// Returns false if the effect is one of a sensor that the drive lacks, or if no recording
/// distinguishes its law from a simpler one. For friction that depends on the direction, the shaft
/// must turn in both directions.
bool is_observable(const effects::Placed& effect, const erp::Robot& robot,
                   std::span<const residuals::Episode> recordings);

}  // namespace sim::estimation
