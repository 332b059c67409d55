#include <algorithm>

#include "interfaces/robot/check.hpp"

namespace erp::robot_check {

void check_drives(const Robot& robot, Findings& findings) {
  const auto motors = names_of(robot.motor_types), actuators = names_of(robot.actuators);
  for (const Drive& drive : robot.drives) {
    if (drive.load.size() != 1)
      findings.add(drive, std::to_string(drive.load.size()) + " loads",
                   "give one <slide> or one <shaft>");
    if (std::ranges::count(actuators, drive.name))
      findings.add(drive, "an actuator is also named " + xml::quote(drive.name), "rename it");
    const auto sensors = static_cast<std::size_t>(drive.find<LoadEncoder>() != nullptr) +
                         static_cast<std::size_t>(drive.find<TorqueSensor>() != nullptr);
    if (sensors != drive.sensors.size())
      findings.add(drive, std::to_string(drive.sensors.size()) + " sensors of the load",
                   "give one <load_encoder>, one <torque_sensor>, or one of each");
    if (drive.find<LoadEncoder>() && !drive.stiffness_Nm_per_rad)
      findings.add(drive, "a <load_encoder> behind a transmission without a stiffness",
                   "give stiffness_Nm_per_rad of the transmission between both angles");
    const bool by_force = drive.control == DriveControl::force;
    if (by_force && !drive.motor.empty())
      findings.add(drive, "motor=" + xml::quote(drive.motor) + " with control=\"force\"",
                   "remove motor: the force does not depend on it");
    if (by_force && has_load_sensor(drive))
      findings.add(drive, "sensors of the load with control=\"force\"",
                   "use control=\"voltage\" or \"current\": the motor's own inertia is needed to "
                   "separate motor and load");
    if (!by_force && !std::ranges::count(motors, drive.motor))
      findings.add(drive, "motor=" + xml::quote(drive.motor) + " refers to an unknown motor_type",
                   motors.empty() ? std::string("the robot has none: add a motor_type")
                                  : xml::did_you_mean(drive.motor, motors));
  }
}

}  // namespace erp::robot_check
