#pragma once
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"

/// Names of the columns of a robot's table (table.hpp), in the order of writing: six signals of
/// each actuator, then the angle or quaternion of each joint.
namespace recording {

inline constexpr const char* actuator_signals[] = {"mode",      "reference", "voltage_V",
                                                   "current_A", "shaft_rad", "tension_N"};
inline constexpr const char* quaternion_parts[] = {"qw", "qx", "qy", "qz"};

/// One column for a revolute joint, four for a spherical one.
inline std::vector<std::string> columns_of(const erp::Joint& joint) {
  std::vector<std::string> names;
  if (joint.type == erp::JointType::revolute) names.push_back(joint.name + ".angle_rad");
  if (joint.type == erp::JointType::spherical)
    for (const char* part : quaternion_parts) names.push_back(joint.name + "." + part);
  return names;
}

/// All columns of a robot except time_s, which comes first.
inline std::vector<std::string> columns_of(const erp::Robot& robot) {
  std::vector<std::string> names;
  for (const erp::Actuator& a : robot.actuators)
    for (const char* signal : actuator_signals) names.push_back(a.name + "." + signal);
  for (const erp::Joint& joint : robot.joints())
    for (std::string& name : columns_of(joint)) names.push_back(std::move(name));
  return names;
}

}  // namespace recording
