#include <map>
#include <utility>

#include "interfaces/robot/check.hpp"
#include "interfaces/xml/values.hpp"

namespace erp::robot_check {
namespace {

constexpr double max_imu_rate_Hz = 500;  // the host reads each IMU every 2 ms
constexpr int max_ecu_address = 126;

/// An ecu_offset can move an address outside the range that the XSD checks.
template <class Item>
void check_ecu_number(const Item& item, Findings& findings) {
  if (item.ecu < 0 || item.ecu > max_ecu_address)
    findings.add(item, "ecu=\"" + std::to_string(item.ecu) + "\" is out of range",
                 "give 0 to 126; in a mirrored part ecu_offset is added");
}

void check_channels(const Robot& robot, Findings& findings) {
  std::map<std::pair<int, int>, const Actuator*> actuator_of_channel;
  for (const Actuator& actuator : robot.actuators) {
    check_ecu_number(actuator, findings);
    const auto [first, is_free] =
        actuator_of_channel.emplace(std::pair(actuator.ecu, actuator.channel), &actuator);
    if (!is_free)
      findings.add(actuator,
                   "ecu=\"" + std::to_string(actuator.ecu) + "\" channel=\"" +
                       std::to_string(actuator.channel) + "\" already drives " +
                       xml::quote(first->second->name),
                   "choose a free channel; the first is at " + place_text(first->second->place));
  }
}

/// The quantity that each ECU input in use measures, and the number of sensors of each quantity.
struct UsedInputs {
  std::map<std::pair<int, int>, std::string> quantity_of_input;
  std::map<std::string, int> sensor_count;
};

template <class Sensor>
void check_input(const Sensor& sensor, const std::string& quantity, UsedInputs& inputs,
                 Findings& findings) {
  check_ecu_number(sensor, findings);
  const auto [first, is_free] =
      inputs.quantity_of_input.emplace(std::pair(sensor.ecu, sensor.input), quantity);
  if (!is_free)
    findings.add(sensor,
                 "ecu=\"" + std::to_string(sensor.ecu) + "\" input=\"" +
                     std::to_string(sensor.input) + "\" already reads " + first->second,
                 "choose a free input");
  if (inputs.sensor_count[quantity]++ > 0)
    findings.add(sensor, "a second sensor on " + quantity, "keep one");
}

void check_inputs(const Robot& robot, Findings& findings) {
  UsedInputs inputs;
  for (const JointSensor& sensor : robot.joint_sensors)
    check_input(sensor, "joint " + xml::quote(sample_name(sensor)), inputs, findings);
  for (const Potentiometer& sensor : robot.potentiometers) {
    check_input(sensor, "the shaft of " + xml::quote(sensor.actuator), inputs, findings);
    if (sensor.start_rad > sensor.range_rad)
      findings.add(sensor,
                   "start_rad=\"" + xml::write_number(sensor.start_rad) +
                       "\" lies beyond range_rad=\"" + xml::write_number(sensor.range_rad) + "\"",
                   "give a value within its range");
  }
}

/// Checks that the joint has the angle that the sensor measures.
void check_angle(const JointSensor& sensor, const Joint& joint, Findings& findings) {
  const std::string joint_text = "joint " + xml::quote(joint.name);
  if (joint.type == JointType::fixed)
    findings.add(sensor, joint_text + " is fixed", "remove the sensor");
  else if (joint.type == JointType::revolute && sensor.about)
    findings.add(sensor, joint_text + " has one angle", "remove about");
  else if (joint.type != JointType::revolute && !sensor.about)
    findings.add(sensor, joint_text + " turns about three axes",
                 "give the component that the sensor reads: about=\"x\", y or z");
  if (sample_name(sensor).size() > max_name_length)
    findings.add(
        sensor, "its name on the bus would be " + xml::quote(sample_name(sensor)),
        "the bus allows " + std::to_string(max_name_length) + " characters: rename the joint");
}

void check_sensed_joints(const Robot& robot, Findings& findings) {
  for (const JointSensor& sensor : robot.joint_sensors)
    for (const Joint& joint : robot.joints())
      if (joint.name == sensor.joint) check_angle(sensor, joint, findings);
  for (const JointSensor& sensor : robot.joint_sensors)
    if (sensor.min_rad && sensor.max_rad && !(*sensor.min_rad < *sensor.max_rad))
      findings.add(sensor,
                   "min_rad=\"" + xml::write_number(*sensor.min_rad) +
                       "\" is not below max_rad=\"" + xml::write_number(*sensor.max_rad) + "\"",
                   "give the lower end as min_rad");
  for (const Imu& imu : robot.imus)
    if (imu.sampling.rate_Hz > max_imu_rate_Hz)
      findings.add(imu, "rate_Hz=\"" + xml::write_number(imu.sampling.rate_Hz) + "\" is too fast",
                   "give at most 500: the host reads it each 2 ms");
}

}  // namespace

void check_ecus(const Robot& robot, Findings& findings) {
  check_channels(robot, findings);
  check_inputs(robot, findings);
  check_sensed_joints(robot, findings);
}

}  // namespace erp::robot_check
