#include "interfaces/robot/robot.hpp"

#include <set>
#include <stdexcept>

#include "interfaces/robot/assemble.hpp"
#include "interfaces/robot/check.hpp"
#include "interfaces/xml/xml.hpp"

namespace erp {

std::vector<Body> Robot::bodies() const {
  std::vector<Body> all;
  for (const Skeleton& part : skeletons)
    all.insert(all.end(), part.bodies.begin(), part.bodies.end());
  return all;
}

std::vector<Joint> Robot::joints() const {
  std::vector<Joint> all;
  for (const Skeleton& part : skeletons)
    all.insert(all.end(), part.joints.begin(), part.joints.end());
  return all;
}

std::string sample_name(const JointSensor& sensor) {
  return sensor.joint + (sensor.about ? "_" + xml::Codec<AxisName>::write(*sensor.about) : "");
}

std::vector<AnalogInput> Robot::analog_inputs() const {
  std::vector<AnalogInput> inputs;
  for (const JointSensor& sensor : joint_sensors)
    inputs.push_back({sensor.ecu, sensor.input, "sensor of joint " + xml::quote(sensor.joint)});
  for (const Potentiometer& sensor : potentiometers)
    inputs.push_back({sensor.ecu, sensor.input, "potentiometer of " + xml::quote(sensor.actuator)});
  return inputs;
}

std::vector<int> Robot::ecus() const {
  std::set<int> addresses;
  for (const Actuator& actuator : actuators) addresses.insert(actuator.ecu);
  for (const AnalogInput& input : analog_inputs()) addresses.insert(input.ecu);
  return {addresses.begin(), addresses.end()};
}

std::vector<BusPlan> Robot::buses() const {
  if (!can_buses.empty()) return can_buses;
  BusPlan single_bus;
  single_bus.name = "can";
  single_bus.ecus = ecus();
  return {single_bus};
}

Vec3 Robot::gravity_m_per_s2() const {
  for (const Skeleton& part : skeletons)
    if (part.gravity_m_per_s2) return *part.gravity_m_per_s2;
  return {0, 0, 0};
}

namespace {
template <class Type>
const Type& find_type(const std::vector<Type>& types, const std::string& name) {
  for (const Type& type : types)
    if (type.name == name) return type;
  throw std::out_of_range(std::string("the robot has no ") + Type::element + " \"" + name + "\"");
}
}  // namespace

const MotorType& Robot::motor_of(const Actuator& actuator) const {
  return find_type(motor_types, actuator.motor);
}

const SensorType& Robot::sensors_of(const Actuator& actuator) const {
  return find_type(sensor_types, actuator.sensors);
}

Robot read_robot(const std::string& file) {
  Robot robot = assemble_robot(file);
  xml::throw_if_any(check_robot(robot));
  return robot;
}

std::string write_robot(const Robot& robot) { return xml::write(robot); }

std::vector<xml::Error> check_robot(const Robot& robot) {
  robot_check::Findings findings;
  check_names(robot, findings);
  check_references(robot, findings);
  check_ecus(robot, findings);
  check_buses(robot, findings);
  check_skeleton(robot, findings);
  check_tendons(robot, findings);
  check_drives(robot, findings);
  return std::move(findings.errors);
}

}  // namespace erp
