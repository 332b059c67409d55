#include "sim/gap/residuals/held_voltage.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

namespace sim::residuals {
namespace {

/// Every result is linear in six quantities: i_0, V_0, V_1, V_2, ω_0 and τ. A row holds its
/// coefficients.
using Row = Eigen::Matrix<double, 1, 6>;
enum Cause { from_i, from_V0, from_V1, from_V2, from_speed, from_load };

/// The state at a row. weighted_speed: ∫ e^(−(t_k − t)R/L) ω dt over the period that ends at the
/// row.
struct State {
  Row current = Row::Zero(), speed = Row::Zero(), angle = Row::Zero(), weighted_speed = Row::Zero();
};

class Motor {
 public:
  Motor(const erp::MotorType& m, double period_s, double delay_s)
      : rate_per_s_(m.resistance_ohm / m.inductance_H), period_s_(period_s), delay_s_(delay_s) {
    const double inertia = shaft_inertia_kg_m2(m), n = m.gear_ratio;
    Eigen::Matrix<double, 6, 6> a = Eigen::Matrix<double, 6, 6>::Zero();  // of the state, V and τ
    a(0, 0) = -rate_per_s_, a(0, 1) = -m.back_emf_V_s_per_rad * n / m.inductance_H;
    a(0, 4) = 1 / m.inductance_H;
    a(1, 0) = m.torque_Nm_per_A * n / inertia, a(1, 5) = -1 / inertia;
    a(2, 1) = 1;
    a(3, 1) = 1, a(3, 3) = -rate_per_s_;
    before_delay_ = (a * delay_s).exp(), after_delay_ = (a * (period_s - delay_s)).exp();
  }

  /// The state after a period. Until the driver's delay has passed, the previous voltage acts.
  State after(const State& before, Cause previous_voltage, Cause voltage) const {
    Eigen::Matrix<double, 6, 6> x = Eigen::Matrix<double, 6, 6>::Zero();
    x.row(0) = before.current, x.row(1) = before.speed, x.row(2) = before.angle;
    x(4, previous_voltage) = 1, x(5, from_load) = 1;
    if (delay_s_ > 0) x = before_delay_ * x;
    x.row(4).setZero(), x(4, voltage) = 1;
    const Eigen::Matrix<double, 6, 6> end = after_delay_ * x;
    return {end.row(0), end.row(1), end.row(2), end.row(3)};
  }
  /// The fraction of a current that remains after a period.
  double decay() const { return std::exp(-rate_per_s_ * period_s_); }
  /// The weighted mean of ω on which the current at a period's end depends.
  Row mean_speed(const State& end) const {
    return rate_per_s_ / (1 - decay()) * end.weighted_speed;
  }
  /// The weight of the previous voltage in the current at a period's end.
  double previous_weight() const {
    return (std::exp(-rate_per_s_ * (period_s_ - delay_s_)) - decay()) / (1 - decay());
  }

 private:
  double rate_per_s_, period_s_, delay_s_;
  Eigen::Matrix<double, 6, 6> before_delay_, after_delay_;
};

}  // namespace

double shaft_inertia_kg_m2(const erp::MotorType& m) {
  return m.rotor_inertia_kg_m2 * m.gear_ratio * m.gear_ratio +
         m.gear_inertia_kg_m2 / m.gear_efficiency;
}

TwoPeriods two_periods(const erp::MotorType& m, double period_s, double delay_s) {
  const Motor motor(m, period_s, delay_s);
  State start;
  start.current[from_i] = 1, start.speed[from_speed] = 1;
  const State middle = motor.after(start, from_V0, from_V1),
              end = motor.after(middle, from_V1, from_V2);
  TwoPeriods two;

  // Each current gives a weighted mean of K_E N ω: p V_k−1 + (1 − p) V_k − R (i_k − d i_k−1)/(1 −
  // d), with d = decay and p = previous_weight. Two of these means determine the speed over both
  // periods, and thus its unweighted mean.
  Eigen::Matrix<double, 2, 6> means;
  means << motor.mean_speed(middle), motor.mean_speed(end);
  const Row mean_speed = end.angle / (2 * period_s);
  const Eigen::RowVector2d weights = mean_speed.tail<2>() * means.rightCols<2>().inverse();
  const double emf = m.back_emf_V_s_per_rad * m.gear_ratio, decay = motor.decay(),
               previous_weight = motor.previous_weight();
  const Eigen::RowVector4d remainder = emf * (mean_speed.head<4>() - weights * means.leftCols<4>());
  two.volts = {
      weights[0] * previous_weight + remainder[from_V0],
      weights[0] * (1 - previous_weight) + weights[1] * previous_weight + remainder[from_V1],
      weights[1] * (1 - previous_weight) + remainder[from_V2]};
  two.amperes = {-(weights[0] * decay) / (1 - decay) - remainder[from_i] / m.resistance_ohm,
                 (weights[0] - weights[1] * decay) / (1 - decay), weights[1] / (1 - decay)};

  // Two currents and two angles are four equations; given i_0 and V_0, the unknowns are V_1, V_2,
  // ω_0 and τ.
  Eigen::Matrix<double, 4, 6> measured;
  measured << middle.current, end.current, middle.angle, end.angle - middle.angle;
  const Eigen::RowVector4d load = measured.rightCols<4>().inverse().row(3);
  const double torque = m.torque_Nm_per_A * m.gear_ratio;
  two.drives = {-load.dot(measured.col(from_i).transpose()) / torque, load[0] / torque,
                load[1] / torque};
  two.drives_per_V = -load.dot(measured.col(from_V0).transpose()) / torque;
  two.drives_per_speed = (load[2] + load[3]) * period_s / torque;
  two.inertia_kg_m2 = (load[2] - load[3]) / 2 * period_s * period_s;
  return two;
}

const TwoPeriods& TwoPeriodsAt::at(double ohm) {
  if (ohm > 0 && std::abs(ohm - motor_.resistance_ohm) > 1e-3 * motor_.resistance_ohm) {
    motor_.resistance_ohm = ohm;
    two_ = two_periods(motor_, period_s_, delay_s_);
  }
  return two_;
}

}  // namespace sim::residuals
