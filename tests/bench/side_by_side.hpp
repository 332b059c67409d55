#pragma once
#include <string>

#include "interfaces/robot/robot.hpp"

/// A robot with `copies` copies of the first skeleton and all actuators of `one`, attached to the common body `base`.
inline erp::Robot side_by_side(const erp::Robot& one, const std::string& base, int copies) {
  erp::Robot robot = one;
  robot.skeletons.clear(), robot.actuators.clear(), robot.joint_sensors.clear();
  for (int copy = 0; copy < copies; ++copy) {
    const auto own = [&](std::string& name) {
      if (name != base) name += "_" + std::to_string(copy);
    };
    erp::Skeleton skeleton = one.skeletons[0];
    if (copy > 0) std::erase_if(skeleton.bodies, [&](auto& b) { return b.name == base; });
    for (auto& body : skeleton.bodies) own(body.name);
    for (auto& joint : skeleton.joints) own(joint.name), own(joint.parent), own(joint.child);
    robot.skeletons.push_back(skeleton);
    for (erp::Actuator actuator : one.actuators) {
      own(actuator.name);
      for (auto& point : actuator.tendon.path) std::visit([&](auto& p) { own(p.body); }, point);
      robot.actuators.push_back(actuator);
    }
    for (erp::JointSensor sensor : one.joint_sensors) {
      own(sensor.joint);
      robot.joint_sensors.push_back(sensor);
    }
  }
  return robot;
}
