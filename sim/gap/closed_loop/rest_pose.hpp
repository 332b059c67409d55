#pragma once
#include <span>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/model/skeleton/joint_path.hpp"

/// Simulated rest pose of a robot whose shafts are at given angles.
namespace sim::closed_loop {

struct RestPoseOptions {
  double ramp_s = 0.7;             ///< duration of the ramp of the shaft angles; chosen
  double still_rad_per_s = 0.002;  ///< speed limit of a joint at rest, for 0.1 s; chosen
  double tolerance_rad = 0.002;    ///< largest error of a shaft at rest; chosen
  double longest_s = 8;            ///< longest simulation of one pose; chosen
};

struct RestPose {
  Pose pose;
  double duration_s = 0;  ///< duration of the motion
  bool at_rest = true;    ///< false: not at rest within RestPoseOptions::longest_s
};

/// Simulates the poses one after the other; the first starts in the initial pose. `shafts_rad`: by
/// pose and actuator, positive: wound up. A PI controller of each shaft's true angle drives the
/// motor within its supply voltage. The robot's effects are simulated. Throws the exceptions of
/// World, and std::runtime_error if the motion is not finite.
std::vector<RestPose> rest_poses(const erp::Robot& robot,
                                 std::span<const std::vector<double>> shafts_rad,
                                 const RestPoseOptions& options = {});

}  // namespace sim::closed_loop
