#pragma once
#include <cstdint>
#include <vector>

#include "sim/residuals/stages.hpp"

/// The noise floor: what the sensors' specification alone leaves in the residuals.
namespace sim::residuals {

/// The same recording as such sensors might have said it another time: noise and half a step of
/// each converter, drawn from the robot's sensor types (and coarser steps that its effects name),
/// on top of what was recorded; of joints without a sensor of the robot's own, as much noise as the
/// recording has; and tensions half a period later and currents 0.3 % larger, which no data sheet
/// excludes.
Episode said_again(const Episode& episode, const erp::Robot& robot, std::uint64_t seed);

/// Of each residual of `stages.residuals(episode)`, the rms of what saying it again changes.
/// `robot` has the sensors. A stage without a window has 0.
std::vector<double> floors(Stages& stages, const Episode& episode, const erp::Robot& robot,
                           std::uint64_t seed = 1);

}  // namespace sim::residuals
