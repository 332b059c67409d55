#include <map>
#include <utility>

#include "interfaces/robot/check.hpp"

namespace erp::robot_check {
namespace {

/// A mirror's offset can carry an ecu out of what the XSD allows.
template <class Item>
void check_ecu_number(const Item& item, Findings& findings) {
  if (item.ecu < 0 || item.ecu > 127)
    findings.add(item, "ecu=\"" + std::to_string(item.ecu) + "\" is out of range",
                 "give 0 to 127; in a mirrored part ecu_offset is added");
}

void check_channels(const Robot& robot, Findings& findings) {
  std::map<std::pair<int, int>, const Actuator*> taken;
  for (const Actuator& actuator : robot.actuators) {
    check_ecu_number(actuator, findings);
    const auto [first, is_free] =
        taken.emplace(std::pair(actuator.ecu, actuator.channel), &actuator);
    if (!is_free)
      findings.add(
          actuator,
          "ecu=\"" + std::to_string(actuator.ecu) + "\" channel=\"" +
              std::to_string(actuator.channel) + "\" drives " + xml::quote(first->second->name) +
              " already",
          "choose a free channel; the first stands at " + place_words(first->second->place));
  }
}

void check_inputs(const Robot& robot, Findings& findings) {
  std::map<std::pair<int, int>, const JointSensor*> taken;
  std::map<std::string, const JointSensor*> sensed;
  for (const JointSensor& sensor : robot.joint_sensors) {
    check_ecu_number(sensor, findings);
    const auto [first, is_free] = taken.emplace(std::pair(sensor.ecu, sensor.input), &sensor);
    if (!is_free)
      findings.add(sensor,
                   "ecu=\"" + std::to_string(sensor.ecu) + "\" input=\"" +
                       std::to_string(sensor.input) + "\" reads " +
                       xml::quote(first->second->joint) + " already",
                   "choose a free input");
    if (!sensed.emplace(sensor.joint, &sensor).second)
      findings.add(sensor, "a second sensor on joint " + xml::quote(sensor.joint), "keep one");
  }
}

void check_sensed_joints(const Robot& robot, Findings& findings) {
  for (const JointSensor& sensor : robot.joint_sensors)
    for (const Joint& joint : robot.joints())
      if (joint.name == sensor.joint && joint.type != JointType::revolute)
        findings.add(sensor, "joint " + xml::quote(joint.name) + " is not revolute",
                     "a joint_sensor reads one angle: remove it");
}

}  // namespace

void check_ecus(const Robot& robot, Findings& findings) {
  check_channels(robot, findings);
  check_inputs(robot, findings);
  check_sensed_joints(robot, findings);
}

}  // namespace erp::robot_check
