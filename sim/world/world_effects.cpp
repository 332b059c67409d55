#include <Eigen/Geometry>
#include <cmath>

#include "sim/model/actuator/sensors.hpp"
#include "sim/world/world.hpp"

/// The effects in the chains and joints of a world.
namespace sim {
effects::ChainSample World::sample(std::size_t k, double dt_s) const {
  const Chain& chain = chains_[k];
  effects::ChainSample s;
  s.dt_s = dt_s;
  s.supply_V = chain.motor.type().supply_V, s.gear_ratio = chain.motor.type().gear_ratio;
  s.current_A = chain.state.current_A, s.current_square_A2 = s.current_A * s.current_A;
  s.shaft_rad = chain.state.shaft_rad, s.speed_rad_per_s = chain.state.speed_rad_per_s;
  s.radius_m = chain.motor.spindle_radius_m();
  s.tension_N = readings_[k].tension_N;
  s.load_Nm = chain.wound.slope * s.tension_N;
  s.path_m = chain.shape.length_m, s.path_change_m = s.path_m - chain.start_m;
  s.wrap_rad = bend_rad(chain.shape);
  s.line_speed_m_per_s = chain.wound.slope * s.speed_rad_per_s;
  return s;
}

World::LineState World::line_state(std::size_t k, double dt_s) {
  Chain& chain = chains_[k];
  constexpr double slack_m = -1;  // any negative stretch
  if (chain.snapped) return {slack_m, 1, {}};
  if (chain.effects.empty())
    return {chain.tendon.stretch_m(chain.shape.length_m, chain.state.shaft_rad), 1, {}};
  effects::ChainSample s = sample(k, dt_s);
  const double r = chain.tendon.radius_m;
  const effects::Sloped path = chain.effects.path(s, {s.path_m, 1});
  s.stretch_m = path.value - chain.tendon.rest_m + r * s.shaft_rad;
  s.stiffness_N_per_m = chain.tendon.spring.slope_N_per_m(s.stretch_m);
  chain.wound = chain.effects.wound(s, {r * s.shaft_rad, r});
  s.stretch_m = path.value - chain.tendon.rest_m + chain.wound.value;
  return {s.stretch_m, path.slope, chain.effects.pull(s)};
}

void World::turn_motor(std::size_t k, double voltage_V, double tension_N, double dt_s) {
  Chain& chain = chains_[k];
  if (chain.effects.empty()) {
    chain.state = sim::step(chain.motor, chain.state, voltage_V, tension_N, dt_s);
    return;
  }
  effects::ChainSample s = sample(k, dt_s);
  s.voltage_V = voltage_V;
  constexpr double min_relative_change = 1e-4;  // chosen: a new motor costs time
  const double resistance_ohm = chain.effects.resistance_ohm(chain.cold_ohm, s);
  if (std::abs(resistance_ohm / chain.motor.type().resistance_ohm - 1) > min_relative_change)
    set_winding_resistance(chain, resistance_ohm);
  const double r = chain.motor.spindle_radius_m();
  s.load_Nm = chain.wound.slope * chain.effects.motor_side_N(tension_N, s);
  const double aged_Nm = chain.effects.aged_Nm(s);
  const MotorLoad load{s.load_Nm / r, chain.effects.friction_Nm(1, s) + aged_Nm,
                       chain.effects.friction_Nm(-1, s) + aged_Nm, chain.effects.rotor_Nm(s)};
  const double delayed_V = chain.effects.delayed_voltage_V(voltage_V, s);
  chain.state =
      sim::step(chain.motor, chain.state, chain.effects.voltage_V(delayed_V, s), load, dt_s);
}

/// Replaces the motor by one with another winding resistance.
void World::set_winding_resistance(Chain& chain, double resistance_ohm) const {
  erp::MotorType type = chain.motor.type();
  type.resistance_ohm = resistance_ohm;
  chain.motor = Motor(type, chain.motor.spindle_radius_m(), options_.usual_step_s);
}

void World::restore_effects(Chain& chain, std::span<const effects::Memory>& memories) const {
  if (chain.effects.empty()) return;
  chain.effects.restore(memories);
  chain.wound = {memories.front()[0], memories.front()[1]};
  if (const double resistance_ohm = memories.front()[2];
      resistance_ohm != chain.motor.type().resistance_ohm)
    set_winding_resistance(chain, resistance_ohm);
  memories = memories.subspan(1);
}

void World::set_joint_friction() {
  for (JointEffects& joint : joint_effects_) {
    const double speed = model_->velocity().segment(joint.first, joint.dofs).norm();
    solver_->set_coulomb(joint.friction, joint.coulomb_Nm + joint.acting.joint_friction_Nm(speed));
  }
}

/// For a ball joint: about the axis of its rotation from the starting pose.
Eigen::VectorXd World::torque_of(JointEffects& joint) const {
  const JointReading& reading = joints()[static_cast<std::size_t>(joint.joint)];
  if (joint.dofs == 1)
    return Eigen::VectorXd::Constant(1, joint.acting.joint_torque(reading.position[0]).value);
  const Eigen::Vector3d rotation_vector(angle_rad(reading, erp::AxisName::x),
                                        angle_rad(reading, erp::AxisName::y),
                                        angle_rad(reading, erp::AxisName::z));
  const double angle = rotation_vector.norm();
  const Eigen::Vector3d axis =
      angle > 0 ? Eigen::Vector3d(rotation_vector / angle) : Eigen::Vector3d::Zero();
  return axis * joint.acting.joint_torque(angle).value;
}

}  // namespace sim
