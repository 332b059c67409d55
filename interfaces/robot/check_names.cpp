#include <algorithm>
#include <cctype>
#include <map>

#include "interfaces/robot/check.hpp"

namespace erp::robot_check {
namespace {

bool is_name_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
}

/// Names are keys of bounded length on the bus, and parts of column names in CSV files.
template <class Item>
void check_name(const Item& item, Findings& findings) {
  const std::string& name = item.name;
  if (name.size() > max_name_length)
    findings.add(item,
                 "name=" + xml::quote(name) + " has " + std::to_string(name.size()) + " characters",
                 "the bus allows at most " + std::to_string(max_name_length));
  if (!std::all_of(name.begin(), name.end(), is_name_character))
    findings.add(item, "name=" + xml::quote(name) + " is not a plain name",
                 "use letters, digits, _ and -");
}

template <class Items>
void check_unique(const Items& items, Findings& findings) {
  std::map<std::string, xml::Place> place_of_name;
  for (const auto& item : items) {
    check_name(item, findings);
    const auto [first, is_new] = place_of_name.emplace(item.name, item.place);
    if (!is_new)
      findings.add(item, "duplicate name " + xml::quote(item.name),
                   "rename it; the first is at " + place_text(first->second));
  }
}

template <class Items>
void check_count(const Robot& robot, const Items& items, std::size_t limit, const char* what,
                 Findings& findings) {
  if (items.size() > limit)
    findings.add(robot, std::to_string(items.size()) + " " + what,
                 "the bus allows at most " + std::to_string(limit));
}

template <class Item>
void check_reference(const Item& item, const char* attribute, const std::string& name,
                     const std::vector<std::string>& valid_names, const char* kind,
                     Findings& findings) {
  if (std::find(valid_names.begin(), valid_names.end(), name) != valid_names.end()) return;
  findings.add(item,
               std::string(attribute) + "=" + xml::quote(name) + " refers to an unknown " + kind,
               valid_names.empty() ? std::string("the robot has none: add a ") + kind
                                   : xml::did_you_mean(name, valid_names));
}

void check_tolerances(const Robot& robot, const std::vector<std::string>& targets,
                      Findings& findings) {
  for (const Tolerance& tolerance : robot.tolerances) {
    if (!tolerance.on.empty())
      check_reference(tolerance, "on", tolerance.on, targets, "actuator, drive, joint or body",
                      findings);
    if (tolerance.relative.has_value() == tolerance.absolute.has_value())
      findings.add(tolerance,
                   tolerance.relative ? "relative and absolute are both given"
                                      : "neither relative nor absolute is given",
                   "give one: relative to the number, or absolute in its unit");
  }
}

}  // namespace

void check_names(const Robot& robot, Findings& findings) {
  check_name(robot, findings);
  check_unique(robot.bodies(), findings);
  check_unique(robot.joints(), findings);
  check_unique(robot.actuators, findings);
  check_unique(robot.can_buses, findings);
  check_unique(robot.drives, findings);
  check_unique(robot.motor_types, findings);
  check_unique(robot.sensor_types, findings);
  check_unique(robot.imus, findings);
  check_count(robot, robot.bodies(), max_bodies, "bodies", findings);
  check_count(robot, robot.joints(), max_joints, "joints", findings);
  check_count(robot, robot.actuators, max_actuators, "actuators", findings);
  check_count(robot, robot.imus, max_imus, "imus", findings);
  check_count(robot, robot.analog_inputs(), max_joints, "analog inputs in use", findings);
}

void check_references(const Robot& robot, Findings& findings) {
  const auto bodies = names_of(robot.bodies()), joints = names_of(robot.joints());
  const auto motors = names_of(robot.motor_types), sensors = names_of(robot.sensor_types);
  for (const Joint& joint : robot.joints()) {
    check_reference(joint, "parent", joint.parent, bodies, "body", findings);
    check_reference(joint, "child", joint.child, bodies, "body", findings);
  }
  for (const Skeleton& part : robot.skeletons)
    for (const Contact& contact : part.contacts) {
      check_reference(contact, "body", contact.body, bodies, "body", findings);
      check_reference(contact, "on", contact.on, bodies, "body", findings);
    }
  for (const Actuator& actuator : robot.actuators) {
    check_reference(actuator, "motor", actuator.motor, motors, "motor_type", findings);
    check_reference(actuator, "sensors", actuator.sensors, sensors, "sensor_type", findings);
    for (const auto& point : actuator.tendon.path)
      std::visit(
          [&](const auto& p) { check_reference(p, "body", p.body, bodies, "body", findings); },
          point);
  }
  for (const JointSensor& sensor : robot.joint_sensors)
    check_reference(sensor, "joint", sensor.joint, joints, "joint", findings);
  const auto actuators = names_of(robot.actuators);
  for (const Potentiometer& sensor : robot.potentiometers)
    check_reference(sensor, "actuator", sensor.actuator, actuators, "actuator", findings);
  for (const Imu& imu : robot.imus)
    check_reference(imu, "body", imu.body, bodies, "body", findings);
  auto targets = joints;
  const auto drives = names_of(robot.drives);
  for (const auto* names : {&bodies, &actuators, &drives})
    targets.insert(targets.end(), names->begin(), names->end());
  for (const Drive& drive : robot.drives)
    if (has_load_sensor(drive)) targets.push_back(drive.name + ".load");
  targets.push_back(robot.name);
  for (const Effect& effect : robot.effects)
    check_reference(effect, "on", effect.on, targets, "actuator, drive, joint, body or robot",
                    findings);
  check_tolerances(robot, targets, findings);
}

}  // namespace erp::robot_check
