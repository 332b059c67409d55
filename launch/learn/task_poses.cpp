#include "launch/learn/task_poses.hpp"

#include <filesystem>

#include "interfaces/recording/csv.hpp"
#include "sim/actuator/pose_plan.hpp"

namespace launch {

std::string beside(const std::string& file, const std::string& named) {
  return (std::filesystem::path(file).parent_path() / named).string();
}

std::vector<sim::Pose> task_poses(const std::string& task_file, const std::string& poses,
                                  const erp::Robot& robot) {
  if (poses.empty()) return {sim::starting_pose(robot)};
  std::vector<sim::Pose> all;
  for (const sim::TimedPose& row :
       sim::poses_of(recording::read_table(beside(task_file, poses)), robot))
    all.push_back(row.pose);
  return all;
}

}  // namespace launch
