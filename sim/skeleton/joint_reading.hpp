#pragma once
#include <array>

#include "interfaces/robot/robot.hpp"

namespace sim {

/// Where a joint is and how it moves.
/// Position: revolute [0] rad; spherical a unit quaternion w x y z from child to parent.
/// Velocity: revolute [0]; spherical x y z in the child's frame.
struct JointReading {
  erp::JointType type = erp::JointType::fixed;
  std::array<double, 4> position{};
  std::array<double, 3> velocity_rad_per_s{};
};

/// How many velocities a joint of that type has.
constexpr int coordinates_of(erp::JointType type) {
  return type == erp::JointType::spherical ? 3 : type == erp::JointType::revolute ? 1 : 0;
}

}  // namespace sim
