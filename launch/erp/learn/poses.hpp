#pragma once
#include "launch/erp/learn/calibrate.hpp"

namespace launch {

/// Reads the poses at rest of recordings.
sim::calibration::PoseSet read_poses(const erp::Robot& robot, const PoseFiles& files);

}  // namespace launch
