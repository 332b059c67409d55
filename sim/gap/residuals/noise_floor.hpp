#pragma once
#include <cstdint>
#include <vector>

#include "sim/gap/residuals/stages.hpp"

/// The noise floor: what the sensors' specification alone leaves in the residuals.
namespace sim::residuals {

/// The same recording as such sensors might have said it another time: noise and half a step of
/// each converter, drawn from the robot's sensor types (and coarser steps that its effects name),
/// on top of what was recorded; of joints without a sensor of the robot's own, as much noise as the
/// recording has; and tensions half a period later and currents 0.3 % larger, which no data sheet
/// excludes.
Episode resampled_noise(const Episode& episode, const erp::Robot& robot, std::uint64_t seed);

/// σ of one residual:
///
///   σ² = n² + ⟨d²⟩    σ_k² = max(σ², n² + d_k²)
///
/// n the rms of what noise changes, d_k what the doubts change at window k. A fast window is in more
/// doubt than a slow one, but none is trusted beyond the rest: laws are approximations.
struct Floor {
  double rms = 0;          ///< σ; 0: no window
  std::vector<double> at;  ///< σ_k
};

/// Of each residual of `stages.residuals(episode)`; `robot` has the sensors.
std::vector<Floor> floors(Stages& stages, const Episode& episode, const erp::Robot& robot,
                          std::uint64_t seed = 1);

}  // namespace sim::residuals
