#pragma once
#include <string>
#include <vector>

#include "sim/model/skeleton/joint_path.hpp"

namespace launch {

/// The poses in the file `poses` of a task, relative to the task file; if `poses` is empty, the
/// starting pose of the robot.
std::vector<sim::Pose> task_poses(const std::string& task_file, const std::string& poses,
                                  const erp::Robot& robot);

}  // namespace launch
