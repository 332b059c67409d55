#include "sim/diagnosis/drives.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sim::diagnosis {
namespace {

struct Load {
  double inertia_kg_m2, way, step_rad;  ///< on the gearbox shaft; way: of the position, a radian
};

Load load_of(const erp::Drive& drive) {
  if (const auto* slide = std::get_if<erp::Slide>(&drive.load.at(0)))
    return {slide->mass_kg * slide->m_per_rad * slide->m_per_rad, slide->m_per_rad,
            slide->step_m / slide->m_per_rad};
  const auto& shaft = std::get<erp::Shaft>(drive.load[0]);
  return {shaft.inertia_kg_m2, 1, shaft.step_rad};
}

erp::MotorType motor_of(const erp::Robot& robot, const erp::Drive& drive) {
  const Load load = load_of(drive);
  erp::MotorType motor;
  if (drive.control == erp::DriveControl::force) {
    motor.resistance_ohm = 1, motor.inductance_H = 1e-6;
    motor.torque_Nm_per_A = drive.gain * load.way;
    motor.rotor_inertia_kg_m2 = load.inertia_kg_m2;
  } else {
    motor = *std::ranges::find(robot.motor_types, drive.motor, &erp::MotorType::name);
    motor.gear_inertia_kg_m2 += load.inertia_kg_m2;
  }
  motor.name = drive.motor + " of " + drive.name;
  return motor;
}

/// Without noise: a drive's sensors are known by their steps, or not at all.
erp::SensorType sensors_of(const erp::Drive& drive, const erp::MotorType& motor) {
  constexpr double exact = 1e-12;
  erp::SensorType sensors;
  sensors.name = "sensors of " + drive.name;
  const double step_rad = load_of(drive).step_rad;
  sensors.encoder_counts_per_rev =
      step_rad > 0 ? static_cast<int>(2 * std::numbers::pi / (step_rad * motor.gear_ratio)) : 0;
  sensors.current_range_A = sensors.tension_range_N = exact;
  return sensors;
}

Signal scaled(Signal signal, double by) {
  for (double& x : signal) x *= by;
  return signal;
}

/// Held until the next row: of row k what was set at k − 1, or the mean of both.
Signal held(const Signal& set, double of_now) {
  Signal held = set;
  for (std::size_t k = 1; k < set.size(); ++k)
    held[k] = of_now * set[k] + (1 - of_now) * set[k - 1];
  return held;
}

}  // namespace

erp::Robot as_chains(const erp::Robot& robot) {
  erp::Robot chains = robot;
  for (const erp::Drive& drive : robot.drives) {
    chains.motor_types.push_back(motor_of(robot, drive));
    chains.sensor_types.push_back(sensors_of(drive, chains.motor_types.back()));
    erp::Actuator actuator;
    actuator.name = drive.name;
    actuator.motor = chains.motor_types.back().name;
    actuator.sensors = chains.sensor_types.back().name;
    actuator.spindle.radius_m = actuator.tendon.stiffness_N_per_m = 1;
    chains.actuators.push_back(actuator);
  }
  return chains;
}

const erp::Drive* drive_of(const erp::Robot& robot, const std::string& actuator) {
  const auto found = std::ranges::find(robot.drives, actuator, &erp::Drive::name);
  return found == robot.drives.end() ? nullptr : &*found;
}

std::array<std::string, 3> drive_columns(const erp::Drive& drive) {
  const bool slides = std::holds_alternative<erp::Slide>(drive.load.at(0));
  return {drive.name + ".control_V", drive.name + (slides ? ".position_m" : ".position_rad"),
          drive.name + ".current_A"};
}

ActuatorSignals drive_signals(const erp::Drive& drive, const Signal& control_V,
                              const Signal& position, const Signal& current_A) {
  ActuatorSignals s;
  s.shaft_rad = scaled(position, 1 / load_of(drive).way);
  s.tension_N.assign(position.size(), 0.0);
  if (drive.control == erp::DriveControl::voltage)
    s.voltage_V = held(scaled(control_V, drive.gain), 0);
  if (drive.control == erp::DriveControl::current)
    s.current_A = held(scaled(control_V, drive.gain), 0.5);
  if (drive.control == erp::DriveControl::force) s.current_A = held(control_V, 0.5);
  s.current_around = drive.control != erp::DriveControl::voltage;
  if (!current_A.empty() && drive.control != erp::DriveControl::force)
    s.current_A = current_A, s.current_around = false;
  return s;
}

}  // namespace sim::diagnosis
