#pragma once
#include <span>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/model/skeleton/joint_path.hpp"

/// Where a robot comes to stand in the simulator when its shafts are wound to given angles.
namespace sim::closed_loop {

struct RestPoseOptions {
  double way_s = 0.7;              ///< shafts go there straight, so long
  double still_rad_per_s = 0.002;  ///< slower than that for 0.1 s, it stands; chosen
  double wound_rad = 0.002;        ///< and no shaft is farther off
  double most_s = 8;               ///< then it is left as it is
};

struct RestPose {
  Pose pose;
  double after_s = 0;   ///< since its shafts were asked
  bool at_rest = true;  ///< false: it did not come to rest in time
};

/// One after the other, the first from the starting pose. Shaft angles by actuator, positive wound
/// up; a PI law on each shaft's true angle winds it, with the motor's own voltage and torque. The
/// robot's effects act. Throws as World does, and std::runtime_error: the motion is not finite.
std::vector<RestPose> rest_poses(const erp::Robot& robot,
                                 std::span<const std::vector<double>> shafts_rad,
                                 const RestPoseOptions& options = {});

}  // namespace sim::closed_loop
