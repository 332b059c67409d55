#include <algorithm>

#include "interfaces/robot/check.hpp"

namespace erp::robot_check {

void check_drives(const Robot& robot, Findings& findings) {
  const auto motors = names_of(robot.motor_types), muscles = names_of(robot.actuators);
  for (const Drive& drive : robot.drives) {
    if (drive.load.size() != 1)
      findings.add(drive, std::to_string(drive.load.size()) + " loads",
                   "give one <slide> or one <shaft>");
    if (std::ranges::count(muscles, drive.name))
      findings.add(drive, "an actuator is called " + xml::quote(drive.name) + " too", "rename it");
    const auto sensors = static_cast<std::size_t>(drive.find<LoadEncoder>() != nullptr) +
                         static_cast<std::size_t>(drive.find<TorqueSensor>() != nullptr);
    if (sensors != drive.sensors.size())
      findings.add(drive, std::to_string(drive.sensors.size()) + " sensors of the load",
                   "give one <load_encoder>, one <torque_sensor>, or one of each");
    if (drive.find<LoadEncoder>() && !drive.stiffness_Nm_per_rad)
      findings.add(drive, "a <load_encoder> behind a transmission without a stiffness",
                   "give stiffness_Nm_per_rad: what lies between both angles");
    const bool by_force = drive.control == DriveControl::force;
    if (by_force && !drive.motor.empty())
      findings.add(drive, "motor=" + xml::quote(drive.motor) + " with control=\"force\"",
                   "leave motor out: the force is known without it");
    if (by_force && has_two_ends(drive))
      findings.add(drive, "sensors of the load with control=\"force\"",
                   "control by voltage or current: motor and load are told apart by the motor's "
                   "own inertia");
    if (!by_force && !std::ranges::count(motors, drive.motor))
      findings.add(drive, "motor=" + xml::quote(drive.motor) + " names no motor_type",
                   motors.empty() ? std::string("the robot has none: add a motor_type")
                                  : xml::did_you_mean(drive.motor, motors));
  }
}

}  // namespace erp::robot_check
