#pragma once
#include "launch/erp/learn/calibrate.hpp"

namespace launch {

/// Reads the poses at rest from recordings. Throws RecordingError, and std::invalid_argument with
/// the file.
sim::calibration::PoseSet read_poses(const erp::Robot& robot, const PoseFiles& files);

}  // namespace launch
