#pragma once
#include "launch/erp/learn/calibrate.hpp"

namespace launch {

/// The still poses of recordings.
sim::calibration::PoseSet read_poses(const erp::Robot& robot, const PoseFiles& files);

}  // namespace launch
