#include "sim/gap/residuals/drives.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sim::residuals {
namespace {

struct Load {
  double inertia_kg_m2;  ///< at the gearbox shaft
  double travel;         ///< of the position per radian
  double step_rad;       ///< of the encoder
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
    motor.torque_Nm_per_A = drive.gain * load.travel;
    motor.rotor_inertia_kg_m2 = load.inertia_kg_m2;
  } else {
    motor = *std::ranges::find(robot.motor_types, drive.motor, &erp::MotorType::name);
    if (!has_load_sensor(drive)) motor.gear_inertia_kg_m2 += load.inertia_kg_m2;
  }
  motor.name = drive.motor + " of " + drive.name;
  return motor;
}

/// Sensors without noise. At most the steps of a drive's sensors are specified.
erp::SensorType sensors_of(const erp::Drive& drive, const erp::MotorType& motor) {
  constexpr double no_quantization = 1e-12;  // range that makes the steps negligible
  erp::SensorType sensors;
  sensors.name = "sensors of " + drive.name;
  const double step_rad = load_of(drive).step_rad;
  sensors.encoder_counts_per_rev =
      step_rad > 0 ? static_cast<int>(2 * std::numbers::pi / (step_rad * motor.gear_ratio)) : 0;
  sensors.current_range_A = sensors.tension_range_N = no_quantization;
  if (const auto* torque = drive.find<erp::TorqueSensor>())
    sensors.tension_noise_N = torque->noise_Nm;
  return sensors;
}

Signal scaled(Signal signal, double factor) {
  for (double& x : signal) x *= factor;
  return signal;
}

/// A command that is held until the next row: weight · u_k + (1 − weight) · u_k−1.
Signal held(const Signal& command, double weight) {
  Signal mean = command;
  for (std::size_t k = 1; k < command.size(); ++k)
    mean[k] = weight * command[k] + (1 - weight) * command[k - 1];
  return mean;
}

/// The load as a hinge on which only the transmission acts.
erp::Skeleton hinge_of(const erp::Drive& drive) {
  constexpr double no_stop_rad = 1e9, any_kg = 1;  // the centre of mass lies on the axis
  erp::Body base, load;
  base.name = drive.name + ".base", load.name = drive.name + ".load", load.mass_kg = any_kg;
  load.inertia_kg_m2.fill(load_of(drive).inertia_kg_m2);
  erp::Joint hinge;
  hinge.name = drive.name, hinge.parent = base.name, hinge.child = load.name;
  hinge.min_rad = -no_stop_rad, hinge.max_rad = no_stop_rad;
  erp::Skeleton skeleton;
  skeleton.bodies = {base, load}, skeleton.joints = {hinge};
  return skeleton;
}

erp::Tendon transmission_of(const erp::Drive& drive) {
  constexpr double unused_stiffness = 1;  // of a drive without a stiffness
  erp::Tendon tendon;
  tendon.stiffness_N_per_m = drive.stiffness_Nm_per_rad.value_or(unused_stiffness);
  tendon.damping_N_s_per_m = drive.damping_Nm_s_per_rad;
  return tendon;
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
    actuator.spindle.radius_m = 1, actuator.tendon = transmission_of(drive);
    if (has_load_sensor(drive)) chains.skeletons.push_back(hinge_of(drive));
    chains.actuators.push_back(actuator);
  }
  return chains;
}

const erp::Drive* drive_of(const erp::Robot& robot, const std::string& actuator) {
  const auto drive = std::ranges::find(robot.drives, actuator, &erp::Drive::name);
  return drive == robot.drives.end() ? nullptr : &*drive;
}

DriveRecord<std::string> drive_columns(const erp::Drive& drive) {
  const bool slides = std::holds_alternative<erp::Slide>(drive.load.at(0));
  const std::string unit = slides ? "_m" : "_rad", d = drive.name + ".";
  return {d + "control_V", d + "position" + unit, d + "current_A", d + "load" + unit,
          d + (slides ? "force_N" : "torque_Nm")};
}

ActuatorSignals drive_signals(const erp::Drive& drive, const DriveRecord<Signal>& r) {
  ActuatorSignals s;
  s.shaft_rad = scaled(r.position, 1 / load_of(drive).travel);
  if (!has_load_sensor(drive)) s.tension_N.assign(r.position.size(), 0.0);
  else if (drive.find<erp::TorqueSensor>()) s.tension_N = scaled(r.torque, load_of(drive).travel);
  if (drive.control == erp::DriveControl::voltage)
    s.voltage_V = held(scaled(r.control_V, drive.gain), 0);
  if (drive.control == erp::DriveControl::current)
    s.current_A = held(scaled(r.control_V, drive.gain), 0.5);
  if (drive.control == erp::DriveControl::force) s.current_A = held(r.control_V, 0.5);
  s.current_around = drive.control != erp::DriveControl::voltage;
  if (!r.current_A.empty() && drive.control != erp::DriveControl::force)
    s.current_A = r.current_A, s.current_around = false;
  return s;
}

Signal load_rad(const erp::Drive& drive, const DriveRecord<Signal>& r) {
  return scaled(drive.find<erp::LoadEncoder>() ? r.load : r.position, 1 / load_of(drive).travel);
}

}  // namespace sim::residuals
