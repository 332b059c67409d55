#pragma once
#include <span>
#include <string>
#include <vector>

#include "sim/gap/residuals/episode.hpp"
#include "sim/model/effects/library.hpp"

/// Detects quantization steps of sensor readings that are larger than on the data sheet.
namespace sim::diagnosis {

/// Returns the quantization step of the readings, in their unit; 0 if there are too few. Robust to
/// rounding by the converter. Returns `finest` if a larger step is not statistically significant.
double quantization_step(std::span<const residuals::Signal* const> readings, double finest);

/// Returns a sensor_…_quantisation effect for each sensor whose step in all recordings is more than
/// 1.8 times the step of its data sheet.
std::vector<effects::Placed> coarse_sensors(std::span<const residuals::Episode> episodes,
                                            const erp::Robot& robot);

}  // namespace sim::diagnosis
