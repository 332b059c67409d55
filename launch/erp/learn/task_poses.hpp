#pragma once
#include <string>
#include <vector>

#include "sim/model/skeleton/joint_path.hpp"

namespace launch {

/// The rows of the poses.csv that a task names, or the robot's starting pose if it names none.
std::vector<sim::Pose> task_poses(const std::string& task_file, const std::string& poses,
                                  const erp::Robot& robot);

}  // namespace launch
