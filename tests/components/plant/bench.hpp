#pragma once
#include <cstdint>

#include "components/plant/plant.hpp"

/// A plant with one actuator. The test sends the messages of controllers and of the ECU.
namespace bench {

using erp::Mode;
using plant::Plant;

inline constexpr std::int64_t ms = 1'000'000;

inline erp::Robot one_muscle(erp::SafeAction safe = erp::SafeAction::relax) {
  erp::Robot robot;
  robot.name = "one";
  erp::MotorType motor;
  motor.name = "m";
  motor.resistance_ohm = 0.5, motor.inductance_H = 5e-5, motor.back_emf_V_s_per_rad = 0.0115;
  motor.torque_Nm_per_A = 0.0115, motor.gear_ratio = 128, motor.gear_efficiency = 0.59;
  motor.rotor_inertia_kg_m2 = 14.5e-7, motor.supply_V = 12, motor.current_limit_A = 4;
  robot.motor_types.push_back(motor);
  erp::SensorType sensors;
  sensors.name = "s";
  robot.sensor_types.push_back(sensors);
  erp::Actuator actuator;
  actuator.name = "flexor", actuator.motor = "m", actuator.sensors = "s";
  actuator.max_tension_N = 150, actuator.safe_action = safe, actuator.spindle.radius_m = 0.0045;
  actuator.tendon.stiffness_N_per_m = 6000, actuator.tendon.damping_N_s_per_m = 20;
  robot.actuators.push_back(actuator);
  return robot;
}

/// A plant, its time, and functions that send the messages of controllers and of the ECU.
struct Bench {
  Plant plant;
  std::int64_t now_ns = 1000 * ms;
  std::uint64_t sequence = 0;
  bool zero_known = true;
  explicit Bench(erp::SafeAction safe = erp::SafeAction::relax) : Bench(one_muscle(safe)) {}
  explicit Bench(const erp::Robot& robot) : plant({}, robot) {}

  void ecu_reports(ecu_state state, std::uint8_t fault = 0, std::int32_t encoder = 0,
                   std::uint16_t tension = 819) {
    erp::EcuFrame frame;
    frame.sequence = sequence++;
    frame.stamp_ns = now_ns;
    erp::EcuChannelSample channel{};
    channel.fresh = true, channel.state = static_cast<std::uint8_t>(state), channel.fault = fault;
    channel.zero_known = zero_known;
    channel.encoder_counts = encoder, channel.tension_counts = tension;
    erp::append(frame.channels, channel);
    plant.sense(frame, now_ns);
  }
  void command(const char* controller, int priority, Mode mode, double reference) {
    erp::ActuatorCommand command;
    erp::assign(command.controller, controller);
    command.priority = priority;
    erp::ActuatorReference r{};
    erp::assign(r.name, "flexor");
    r.mode = static_cast<std::uint8_t>(mode), r.reference = reference;
    erp::append(command.actuators, r);
    plant.receive(command, now_ns);
  }
  erp::EcuChannelCommand request() { return plant.command(now_ns).channels._buffer[0]; }
  erp::ActuatorOwnerSample owner() { return plant.owners().actuators._buffer[0]; }
  void run(const char* controller = "a", Mode mode = Mode::force, double reference = 20) {
    ecu_reports(ECU_STATE_ARMED);
    now_ns += 2 * ms;
    command(controller, 0, mode, reference);
    ecu_reports(ECU_STATE_RUNNING);
    request();
  }
};

}  // namespace bench
