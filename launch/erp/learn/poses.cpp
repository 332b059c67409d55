#include "launch/erp/learn/poses.hpp"

namespace launch {
namespace {

namespace calibration = sim::calibration;

std::vector<calibration::StillPose> poses_in(const erp::Robot& robot,
                                             const std::vector<std::string>& files) {
  std::vector<calibration::StillPose> all;
  for (const std::string& file : files) try {
      const auto poses = calibration::still_poses(recording::read_table(file), robot);
      all.insert(all.end(), poses.begin(), poses.end());
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(file + ": " + error.what());
    }
  return all;
}

}  // namespace

calibration::PoseSet read_poses(const erp::Robot& robot, const PoseFiles& files) {
  auto training_poses = poses_in(robot, files.learn);
  if (files.check.empty()) return calibration::split(std::move(training_poses));
  return {std::move(training_poses), poses_in(robot, files.check)};
}

}  // namespace launch
