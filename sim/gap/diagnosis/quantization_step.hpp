#pragma once
#include <span>
#include <string>
#include <vector>

#include "sim/gap/residuals/episode.hpp"
#include "sim/model/effects/library.hpp"

/// Whether a sensor's readings sit on a coarser lattice than its data sheet says.
namespace sim::diagnosis {

/// The step between readings that are neighbours; 0: too few to tell. Robust to steps that the
/// converter rounds; what chance may do as well is no step: `finest` then.
double quantization_step(std::span<const residuals::Signal* const> readings, double finest);

/// A sensor_…_quantisation effect for each sensor whose step is at least 1.8 times its data
/// sheet's, in any of the recordings taken together.
std::vector<effects::Placed> coarse_sensors(std::span<const residuals::Episode> episodes,
                                            const erp::Robot& robot);

}  // namespace sim::diagnosis
