#pragma once
#include <array>

#include "interfaces/robot/robot.hpp"

namespace sim {

/// Position and velocity of a joint.
/// Position: revolute [0] rad; spherical and free a unit quaternion w x y z from child to parent.
/// Velocity: revolute [0]; spherical and free x y z in the child's frame.
struct JointReading {
  erp::JointType type = erp::JointType::fixed;
  std::array<double, 4> position{};
  std::array<double, 3> velocity_rad_per_s{};
  std::array<double, 3> offset_m{};  ///< free only: child's origin relative to the joint's position
  std::array<double, 3>
      slide_m_per_s{};  ///< free only: velocity of the centre of mass; both in the parent's frame
};

/// Starting position of a joint: the initial angle of revolute joints, parallel frames for the
/// others.
inline JointReading initial_reading(const erp::Joint& joint) {
  const bool turns = joint.type == erp::JointType::spherical || joint.type == erp::JointType::free;
  return {joint.type, {turns ? 1.0 : joint.initial_rad}, {}, {}, {}};
}

/// Number of velocity coordinates of a joint type.
constexpr int coordinates_of(erp::JointType type) {
  switch (type) {
    case erp::JointType::revolute:
      return 1;
    case erp::JointType::spherical:
      return 3;
    case erp::JointType::free:
      return 6;
    case erp::JointType::fixed:
      break;
  }
  return 0;
}

}  // namespace sim
