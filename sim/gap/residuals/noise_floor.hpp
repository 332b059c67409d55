#pragma once
#include <cstdint>
#include <vector>

#include "sim/gap/residuals/stages.hpp"

/// The noise floor: the residuals that only the specified sensor noise causes.
namespace sim::residuals {

/// Adds another realization of the sensor noise to a recording: noise and quantization of each
/// converter by the robot's sensor types, and the coarser steps of its effects. For joints without
/// a specified sensor, the noise is estimated from the recording. Also applies the deviations that
/// no data sheet excludes: a delay of tensions by half a period, and a gain error of currents of
/// 0.3 %.
Episode resampled_noise(const Episode& episode, const erp::Robot& robot, std::uint64_t seed);

/// σ of one residual:
///
///   σ² = n² + ⟨d²⟩    σ_k² = max(σ², n² + d_k²)
///
/// n: rms change of the residual by noise; d_k: its change at window k by the deviations that no
/// data sheet excludes, which is larger in fast windows. σ_k is at least σ because the laws are
/// approximations.
struct Floor {
  double rms = 0;                 ///< σ; 0: no window
  std::vector<double> by_window;  ///< σ_k
};

/// Returns a floor for each residual of `stages.residuals(episode)`. `robot` specifies the sensors.
std::vector<Floor> floors(Stages& stages, const Episode& episode, const erp::Robot& robot,
                          std::uint64_t seed = 1);

}  // namespace sim::residuals
