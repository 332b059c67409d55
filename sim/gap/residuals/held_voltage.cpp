#include "sim/gap/residuals/held_voltage.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

namespace sim::residuals {
namespace {

/// Every result is linear in six quantities: i_0, V_0, V_1, V_2, ω_0 and τ. A row holds its coefficients.
using Row = Eigen::Matrix<double, 1, 6>;
enum Cause { from_i, from_V0, from_V1, from_V2, from_speed, from_load };

/// A state: current, speed, angle and weighted = ∫ e^(−(t_k − t)R/L) ω dt over the period that ends.
struct State {
  Row current = Row::Zero(), speed = Row::Zero(), angle = Row::Zero(), weighted = Row::Zero();
};

class Motor {
 public:
  Motor(const erp::MotorType& m, double period_s, double late_s)
      : rate_per_s_(m.resistance_ohm / m.inductance_H), period_s_(period_s), late_s_(late_s) {
    const double inertia = shaft_inertia_kg_m2(m), n = m.gear_ratio;
    Eigen::Matrix<double, 6, 6> a = Eigen::Matrix<double, 6, 6>::Zero();  // state; V, τ
    a(0, 0) = -rate_per_s_, a(0, 1) = -m.back_emf_V_s_per_rad * n / m.inductance_H;
    a(0, 4) = 1 / m.inductance_H;
    a(1, 0) = m.torque_Nm_per_A * n / inertia, a(1, 5) = -1 / inertia;
    a(2, 1) = 1;
    a(3, 1) = 1, a(3, 3) = -rate_per_s_;
    until_late_ = (a * late_s).exp(), after_late_ = (a * (period_s - late_s)).exp();
  }

  /// The state after a period; in its first part the previous voltage still acts.
  State after(const State& before, Cause old, Cause voltage) const {
    Eigen::Matrix<double, 6, 6> x = Eigen::Matrix<double, 6, 6>::Zero();
    x.row(0) = before.current, x.row(1) = before.speed, x.row(2) = before.angle;
    x(4, old) = 1, x(5, from_load) = 1;
    if (late_s_ > 0) x = until_late_ * x;
    x.row(4).setZero(), x(4, voltage) = 1;
    const Eigen::Matrix<double, 6, 6> end = after_late_ * x;
    return {end.row(0), end.row(1), end.row(2), end.row(3)};
  }
  /// The share of a current that remains after a period.
  double kept() const { return std::exp(-rate_per_s_ * period_s_); }
  /// The weighted mean of ω on which the current at a period's end depends.
  Row mean_speed(const State& end) const { return rate_per_s_ / (1 - kept()) * end.weighted; }
  /// The weight of the previous voltage in that current.
  double old() const {
    return (std::exp(-rate_per_s_ * (period_s_ - late_s_)) - kept()) / (1 - kept());
  }

 private:
  double rate_per_s_, period_s_, late_s_;
  Eigen::Matrix<double, 6, 6> until_late_, after_late_;
};

}  // namespace

double shaft_inertia_kg_m2(const erp::MotorType& m) {
  return m.rotor_inertia_kg_m2 * m.gear_ratio * m.gear_ratio +
         m.gear_inertia_kg_m2 / m.gear_efficiency;
}

TwoPeriods two_periods(const erp::MotorType& m, double period_s, double late_s) {
  const Motor motor(m, period_s, late_s);
  State start;
  start.current[from_i] = 1, start.speed[from_speed] = 1;
  const State middle = motor.after(start, from_V0, from_V1),
              end = motor.after(middle, from_V1, from_V2);
  TwoPeriods two;

  // The exact weighted mean of K_E N ω by each current: old V_k−1 + (1 − old) V_k − R (i_k − kept i_k−1)/(1 − kept).
  // Two such means determine the speed over both periods, and so its unweighted mean.
  Eigen::Matrix<double, 2, 6> means;
  means << motor.mean_speed(middle), motor.mean_speed(end);
  const Row turn = end.angle / (2 * period_s);
  const Eigen::RowVector2d share = turn.tail<2>() * means.rightCols<2>().inverse();
  const double emf = m.back_emf_V_s_per_rad * m.gear_ratio, kept = motor.kept(), old = motor.old();
  const Eigen::RowVector4d rest = emf * (turn.head<4>() - share * means.leftCols<4>());
  two.volts = {share[0] * old + rest[from_V0],
               share[0] * (1 - old) + share[1] * old + rest[from_V1],
               share[1] * (1 - old) + rest[from_V2]};
  two.amperes = {-(share[0] * kept) / (1 - kept) - rest[from_i] / m.resistance_ohm,
                 (share[0] - share[1] * kept) / (1 - kept), share[1] / (1 - kept)};

  // Two currents and two angles are four equations; given i_0 and V_0, the unknowns are V_1, V_2, ω_0 and τ.
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
    two_ = two_periods(motor_, period_s_, late_s_);
  }
  return two_;
}

}  // namespace sim::residuals
