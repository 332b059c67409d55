#pragma once
#include <string>

#include "interfaces/robot/robot.hpp"

/// Returns a robot with `copies` copies of the first skeleton and all actuators of `original`. All
/// copies share the body `base`. The names of copied parts end with the number of the copy.
inline erp::Robot side_by_side(const erp::Robot& original, const std::string& base, int copies) {
  erp::Robot robot = original;
  robot.skeletons.clear(), robot.actuators.clear(), robot.joint_sensors.clear();
  for (int copy = 0; copy < copies; ++copy) {
    const auto rename_copy = [&](std::string& name) {
      if (name != base) name += "_" + std::to_string(copy);
    };
    erp::Skeleton skeleton = original.skeletons[0];
    if (copy > 0) std::erase_if(skeleton.bodies, [&](auto& b) { return b.name == base; });
    for (auto& body : skeleton.bodies) rename_copy(body.name);
    for (auto& joint : skeleton.joints)
      rename_copy(joint.name), rename_copy(joint.parent), rename_copy(joint.child);
    robot.skeletons.push_back(skeleton);
    for (erp::Actuator actuator : original.actuators) {
      rename_copy(actuator.name);
      for (auto& point : actuator.tendon.path)
        std::visit([&](auto& p) { rename_copy(p.body); }, point);
      robot.actuators.push_back(actuator);
    }
    for (erp::JointSensor sensor : original.joint_sensors) {
      rename_copy(sensor.joint);
      robot.joint_sensors.push_back(sensor);
    }
  }
  return robot;
}
