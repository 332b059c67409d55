#pragma once
#include <array>

#include "interfaces/robot/robot.hpp"

namespace sim {

/// Where a joint is and how it moves.
/// Position: revolute [0] rad; spherical and free a unit quaternion w x y z from child to parent.
/// Velocity: revolute [0]; spherical and free x y z in the child's frame.
struct JointReading {
  erp::JointType type = erp::JointType::fixed;
  std::array<double, 4> position{};
  std::array<double, 3> velocity_rad_per_s{};
  std::array<double, 3> offset_m{};  ///< free only: of the child's origin from the joint's place
  std::array<double, 3> slide_m_per_s{};  ///< of its centre of mass; both in the parent's frame
};

/// Where a joint starts: revolute joints at their initial angle, the others with all frames
/// parallel.
inline JointReading start_of(const erp::Joint& joint) {
  const bool turns = joint.type == erp::JointType::spherical || joint.type == erp::JointType::free;
  return {joint.type, {turns ? 1.0 : joint.initial_rad}, {}, {}, {}};
}

/// How many velocities a joint of that type has.
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
