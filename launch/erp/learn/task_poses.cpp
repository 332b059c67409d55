#include "launch/erp/learn/task_poses.hpp"

#include "interfaces/recording/csv.hpp"
#include "interfaces/xml/document.hpp"
#include "sim/control/pose_plan.hpp"

namespace launch {

std::vector<sim::Pose> task_poses(const std::string& task_file, const std::string& poses,
                                  const erp::Robot& robot) {
  if (poses.empty()) return {sim::starting_pose(robot)};
  std::vector<sim::Pose> all;
  for (const sim::TimedPose& row :
       sim::poses_of(recording::read_table(xml::resolved(poses, task_file)), robot))
    all.push_back(row.pose);
  return all;
}

}  // namespace launch
