#pragma once
#include <cstdint>
#include <vector>

#include "sim/gap/residuals/stages.hpp"

/// The noise floor: the residuals that the specified sensor noise alone causes.
namespace sim::residuals {

/// The same recording with another realization of the sensor noise added: noise and quantization of each converter by
/// the robot's sensor types, and the coarser steps of its effects. For joints without a specified sensor, the noise
/// estimated from the recording. Also the deviations that no data sheet excludes: tensions half a period later,
/// currents 0.3 % larger.
Episode resampled_noise(const Episode& episode, const erp::Robot& robot, std::uint64_t seed);

/// σ of one residual:
///
///   σ² = n² + ⟨d²⟩    σ_k² = max(σ², n² + d_k²)
///
/// n: rms change of the residual by noise; d_k: its change at window k by the deviations that no data sheet excludes.
/// d_k is larger in fast windows; σ_k is at least σ in every window, for the laws are approximations.
struct Floor {
  double rms = 0;          ///< σ; 0: no window
  std::vector<double> at;  ///< σ_k
};

/// One for each residual of `stages.residuals(episode)`; `robot` specifies the sensors.
std::vector<Floor> floors(Stages& stages, const Episode& episode, const erp::Robot& robot,
                          std::uint64_t seed = 1);

}  // namespace sim::residuals
