#pragma once
#include <cmath>
#include <vector>

#include "interfaces/recording/table.hpp"
#include "sim/control/holding.hpp"
#include "sim/learning/calibration/pose_set.hpp"
#include "tests/sim/rigs.hpp"

/// Poses of the arm at rest.
namespace arm_poses {

inline erp::Robot arm() { return erp::read_robot(rigs::config("arm/robot.xml")); }

/// Poses that the robot holds, computed by statics.
inline std::vector<sim::calibration::StillPose> held_poses(const erp::Robot& robot, int count) {
  std::vector<sim::calibration::StillPose> poses;
  sim::PoseHolder holder(robot);
  for (int k = 0; k < count; ++k) {
    const double turn = 0.25 * std::sin(1.7 * k), elbow = 0.8 + 0.4 * std::cos(2.3 * k);
    sim::calibration::StillPose still{
        double(k), {}, {{std::cos(turn), std::sin(turn), 0, 0}, {elbow}}};
    const auto holding = holder.hold(still.pose);
    for (std::size_t a = 0; a < robot.actuators.size(); ++a)
      still.shaft_rad.push_back(-holding.line_m[a] / robot.actuators[a].spindle.radius_m);
    poses.push_back(still);
  }
  return poses;
}

/// A recording of the poses, each for a second.
inline recording::Table recorded(const erp::Robot& robot,
                                 const std::vector<sim::calibration::StillPose>& poses) {
  recording::Table table{{{"time_s", {}}}};
  for (const erp::Actuator& a : robot.actuators)
    table.columns.push_back({a.name + ".shaft_rad", {}});
  for (const char* name :
       {"shoulder.qw", "shoulder.qx", "shoulder.qy", "shoulder.qz", "elbow.angle_rad"})
    table.columns.push_back({name, {}});
  for (const auto& still : poses)
    for (int k = 0; k < 20; ++k) {
      std::size_t c = 0;
      const auto add = [&](double value) { table.columns[c++].values.push_back(value); };
      add(still.time_s + 0.05 * k);
      for (const double shaft : still.shaft_rad) add(shaft);
      for (const double q : still.pose[0]) add(q);
      add(still.pose[1][0]);
    }
  return table;
}

}  // namespace arm_poses
