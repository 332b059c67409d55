#pragma once
#include <span>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/model/skeleton/joint_path.hpp"

/// Simulated rest pose of a robot whose shafts are wound to given angles.
namespace sim::closed_loop {

struct RestPoseOptions {
  double way_s = 0.7;              ///< duration of the ramp of the shaft angles
  double still_rad_per_s = 0.002;  ///< at rest: slower than this for 0.1 s; chosen
  double wound_rad = 0.002;        ///< at rest: error of every shaft below this; chosen
  double most_s = 8;               ///< longest simulation of one pose
};

struct RestPose {
  Pose pose;
  double after_s = 0;   ///< duration of the motion
  bool at_rest = true;  ///< false: it did not come to rest in time
};

/// Poses are simulated one after the other; the first starts in the initial pose. Shaft angles by actuator,
/// positive: wound up. A PI controller of each shaft's true angle drives the motor within its supply voltage. The
/// robot's effects are simulated. Throws as World, and std::runtime_error if the motion is not finite.
std::vector<RestPose> rest_poses(const erp::Robot& robot,
                                 std::span<const std::vector<double>> shafts_rad,
                                 const RestPoseOptions& options = {});

}  // namespace sim::closed_loop
