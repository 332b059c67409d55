#include "sim/model/actuator/motor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sim {

Motor::Motor(const erp::MotorType& type, double spindle_radius_m, double usual_step_s)
    : type_(type),
      radius_m_(spindle_radius_m),
      usual_step_s_(usual_step_s),
      branches_{branch(1 / type.gear_efficiency), branch(type.gear_efficiency)} {
  if (!(spindle_radius_m > 0)) throw std::invalid_argument("spindle radius_m must be positive");
  // T ~ N J_G (K_T i − µ_M N ω − s τ_CM) + J_M N² (µ_G ω + s τ_CG + r F)
  const double n = type.gear_ratio, j_g = type.gear_inertia_kg_m2;
  mesh_slope_ = {n * j_g * type.torque_Nm_per_A,
                 n * n *
                     (type.rotor_inertia_kg_m2 * type.gear_viscous_Nm_s_per_rad -
                      j_g * type.rotor_viscous_Nm_s_per_rad)};
}

Motor::Branch Motor::branch(double e) const {
  const erp::MotorType& m = type_;
  const double n = m.gear_ratio;
  const double inertia = e * m.rotor_inertia_kg_m2 * n * n + m.gear_inertia_kg_m2;
  const double viscous = e * m.rotor_viscous_Nm_s_per_rad * n * n + m.gear_viscous_Nm_s_per_rad;
  Mat2 a;
  a << -m.resistance_ohm / m.inductance_H, -m.back_emf_V_s_per_rad * n / m.inductance_H,
      e * n * m.torque_Nm_per_A / inertia, -viscous / inertia;
  const PlaneSystem system(a);
  return {system, system.exponential(usual_step_s_), e, inertia};
}

double Motor::dry_friction_Nm(const MotorLoad& load, int direction) const {
  const double extra_Nm = direction > 0 ? load.extra_winding_Nm : load.extra_unwinding_Nm;
  return std::max(0.0, type_.gear_coulomb_Nm + extra_Nm);
}

Vec2 Motor::input(const Branch& b, double voltage_V, const MotorLoad& load, int direction) const {
  const double friction = direction * (b.efficiency * type_.gear_ratio * type_.rotor_coulomb_Nm +
                                       dry_friction_Nm(load, direction));
  const double rotor = b.efficiency * type_.gear_ratio * load.rotor_Nm;
  return {voltage_V / type_.inductance_H,
          -(friction + rotor + radius_m_ * load.tension_N) / b.inertia_kg_m2};
}

double Motor::mesh_constant(const MotorLoad& load, int direction) const {
  const double n = type_.gear_ratio;
  return -n * type_.gear_inertia_kg_m2 * (direction * type_.rotor_coulomb_Nm + load.rotor_Nm) +
         type_.rotor_inertia_kg_m2 * n * n *
             (direction * dry_friction_Nm(load, direction) + radius_m_ * load.tension_N);
}

bool Motor::drives(const MotorState& x, const MotorLoad& load, int direction) const {
  const double mesh =
      mesh_slope_.dot(Vec2(x.current_A, x.speed_rad_per_s)) + mesh_constant(load, direction);
  return mesh * direction >= 0;
}

Motor::Band Motor::band(const MotorLoad& load) const {
  // Breakaway: ω = 0, dω/dt = 0. Then T = X, and the direction of power follows from X.
  const double n = type_.gear_ratio, eta = type_.gear_efficiency;
  const double up = radius_m_ * load.tension_N + dry_friction_Nm(load, 1);
  const double down = radius_m_ * load.tension_N - dry_friction_Nm(load, -1);
  const double e_up = up >= 0 ? eta : 1 / eta, e_down = down > 0 ? 1 / eta : eta;
  return {(down / (e_down * n) - type_.rotor_coulomb_Nm + load.rotor_Nm) / type_.torque_Nm_per_A,
          (up / (e_up * n) + type_.rotor_coulomb_Nm + load.rotor_Nm) / type_.torque_Nm_per_A};
}

int Motor::breakaway(double current_A, const MotorLoad& load) const {
  const Band sticking = band(load);
  return current_A > sticking.high_A ? 1 : current_A < sticking.low_A ? -1 : 0;
}

/// One step as a sequence of motions and rests.
class MotorRun {
 public:
  MotorRun(const Motor& motor, MotorState state, double voltage_V, const MotorLoad& load,
           double dt_s)
      : motor_(motor), x_(state), voltage_V_(voltage_V), load_(load), remaining_s_(dt_s) {}

  /// A step of the usual length without events: one multiplication. Returns false, with the state
  /// unchanged, if there are events.
  bool step_without_events() {
    if (x_.speed_rad_per_s == 0 || remaining_s_ != motor_.usual_step_s_) return false;
    const int direction = x_.speed_rad_per_s > 0 ? 1 : -1;
    const bool drives = motor_.drives(x_, load_, direction);
    const Motor::Branch& b = motor_.branches_[drives];
    const PlaneMotion motion = slide_motion(b, direction);
    const MotorState end = moved(motion, motion.at(b.usual_step), remaining_s_);
    const bool speed_has_extremum = motion.rate({1, 0}).y() * motion.rate(b.usual_step).y() < 0;
    if (speed_has_extremum || end.speed_rad_per_s * direction <= 0) return false;
    if (motor_.drives(end, load_, direction) != drives) return false;
    x_ = end;
    return true;
  }

  const MotorState& state() const { return x_; }

  MotorState run() {
    int direction = x_.speed_rad_per_s > 0   ? 1
                    : x_.speed_rad_per_s < 0 ? -1
                                             : motor_.breakaway(x_.current_A, load_);
    bool drives = motor_.drives(x_, load_, direction);
    for (int events = 0; remaining_s_ > 0 && events < max_events; ++events) {
      if (direction == 0) {
        direction = rest();
        drives = motor_.drives(x_, load_, direction);
        continue;
      }
      const Event event = slide(direction, drives);
      if (event == Event::power_reversal) drives = !drives;
      if (event != Event::stop) continue;
      x_.speed_rad_per_s = 0;
      direction = motor_.breakaway(x_.current_A, load_);
      drives = motor_.drives(x_, load_, direction);
    }
    if (remaining_s_ > 0)
      x_.speed_rad_per_s = 0, rest_for(remaining_s_);  // after too many events the shaft sticks
    return x_;
  }

 private:
  enum class Event { none, stop, power_reversal };
  static constexpr int max_events = 16;  // chosen: limits the time of a step

  PlaneMotion slide_motion(const Motor::Branch& b, int direction) const {
    return {b.system,
            {x_.current_A, x_.speed_rad_per_s},
            motor_.input(b, voltage_V_, load_, direction)};
  }
  MotorState moved(const PlaneMotion& motion, const Vec2& end, double t_s) const {
    return {end.x(), end.y(), x_.shaft_rad + motion.integral(end, t_s).y()};
  }

  /// Moves until the first event or the end of the step.
  Event slide(int direction, bool drives) {
    const PlaneMotion motion = slide_motion(motor_.branches_[drives], direction);
    double t = remaining_s_;
    Event event = Event::none;
    if (const auto stop = motion.first_fall({0.0, direction}, 0, t)) t = *stop, event = Event::stop;
    const double side = drives ? direction : -direction;
    const double mesh = motor_.mesh_constant(load_, direction);
    if (const auto reversal = motion.first_fall(side * motor_.mesh_slope_, side * mesh, t);
        reversal && *reversal > 0 && *reversal < t)
      t = *reversal, event = Event::power_reversal;
    x_ = moved(motion, motion.at(t), t);
    remaining_s_ -= t;
    return event;
  }

  double resting_current_A(double t_s) const {
    const double end_A = voltage_V_ / motor_.type_.resistance_ohm;
    const double rate_per_s = motor_.type_.resistance_ohm / motor_.type_.inductance_H;
    return end_A + (x_.current_A - end_A) * std::exp(-rate_per_s * t_s);
  }
  void rest_for(double t_s) { x_.current_A = resting_current_A(t_s), remaining_s_ -= t_s; }

  /// Rests until the current leaves the friction band or the step ends. Returns the direction of
  /// the following motion, 0 for none.
  int rest() {
    const auto [low_A, high_A] = motor_.band(load_);
    const double end_A = voltage_V_ / motor_.type_.resistance_ohm;
    const int direction = end_A > high_A ? 1 : end_A < low_A ? -1 : 0;
    const double edge_A = direction > 0 ? high_A : low_A;
    // i reaches the edge at t = L/R ln((i0 − i∞) / (edge − i∞)).
    const double t = direction == 0 ? std::numeric_limits<double>::infinity()
                                    : motor_.type_.inductance_H / motor_.type_.resistance_ohm *
                                          std::log((x_.current_A - end_A) / (edge_A - end_A));
    if (t >= remaining_s_) return rest_for(remaining_s_), 0;
    remaining_s_ -= std::max(t, 0.0);
    x_.current_A = edge_A;
    return direction;
  }

  const Motor& motor_;
  MotorState x_;
  double voltage_V_;
  const MotorLoad& load_;
  double remaining_s_;
};

MotorState step(const Motor& motor, MotorState state, double voltage_V, const MotorLoad& load,
                double dt_s) {
  MotorRun run(motor, state, voltage_V, load, dt_s);
  return run.step_without_events() ? run.state() : run.run();
}

}  // namespace sim
