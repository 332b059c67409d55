#include "sim/gap/residuals/held_voltage.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

namespace sim::residuals {
namespace {

/// All follows from six quantities: i_0, V_0, V_1, V_2, ω_0 and τ. A row is how something depends on them.
using Row = Eigen::Matrix<double, 1, 6>;
enum Cause { from_i, from_V0, from_V1, from_V2, from_speed, from_load };

/// A state: current, speed, angle, and y = ∫ e^(−(t_k − t)R/L) ω dt over the period that ends.
struct State {
  Row current = Row::Zero(), speed = Row::Zero(), angle = Row::Zero(), weighed = Row::Zero();
};

class Motor {
 public:
  Motor(const erp::MotorType& m, double period_s, double late_s)
      : rate_per_s_(m.resistance_ohm / m.inductance_H), period_s_(period_s), late_s_(late_s) {
    const double inertia = turned_inertia_kg_m2(m), n = m.gear_ratio;
    Eigen::Matrix<double, 6, 6> a = Eigen::Matrix<double, 6, 6>::Zero();  // state; V, τ
    a(0, 0) = -rate_per_s_, a(0, 1) = -m.back_emf_V_s_per_rad * n / m.inductance_H;
    a(0, 4) = 1 / m.inductance_H;
    a(1, 0) = m.torque_Nm_per_A * n / inertia, a(1, 5) = -1 / inertia;
    a(2, 1) = 1;
    a(3, 1) = 1, a(3, 3) = -rate_per_s_;
    until_late_ = (a * late_s).exp(), after_late_ = (a * (period_s - late_s)).exp();
  }

  /// A period on, in whose first part the voltage before still acts.
  State after(const State& before, Cause old, Cause voltage) const {
    Eigen::Matrix<double, 6, 6> x = Eigen::Matrix<double, 6, 6>::Zero();
    x.row(0) = before.current, x.row(1) = before.speed, x.row(2) = before.angle;
    x(4, old) = 1, x(5, from_load) = 1;
    if (late_s_ > 0) x = until_late_ * x;
    x.row(4).setZero(), x(4, voltage) = 1;
    const Eigen::Matrix<double, 6, 6> end = after_late_ * x;
    return {end.row(0), end.row(1), end.row(2), end.row(3)};
  }
  /// The part of a current that is left after a period.
  double kept() const { return std::exp(-rate_per_s_ * period_s_); }
  /// The mean of ω that the current at a period's end answers to.
  Row answered(const State& end) const { return rate_per_s_ / (1 - kept()) * end.weighed; }
  /// The share of the voltage before in what that current answers to.
  double old() const {
    return (std::exp(-rate_per_s_ * (period_s_ - late_s_)) - kept()) / (1 - kept());
  }

 private:
  double rate_per_s_, period_s_, late_s_;
  Eigen::Matrix<double, 6, 6> until_late_, after_late_;
};

}  // namespace

double turned_inertia_kg_m2(const erp::MotorType& m) {
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

  // K_E N ω as each current answers to it: old V_k−1 + (1 − old) V_k − R (i_k − kept i_k−1)/(1 − kept),
  // exactly. From two such means of ω its course, and so its plain mean.
  Eigen::Matrix<double, 2, 6> means;
  means << motor.answered(middle), motor.answered(end);
  const Row turn = end.angle / (2 * period_s);
  const Eigen::RowVector2d share = turn.tail<2>() * means.rightCols<2>().inverse();
  const double emf = m.back_emf_V_s_per_rad * m.gear_ratio, kept = motor.kept(), old = motor.old();
  const Eigen::RowVector4d rest = emf * (turn.head<4>() - share * means.leftCols<4>());
  two.volts = {share[0] * old + rest[from_V0],
               share[0] * (1 - old) + share[1] * old + rest[from_V1],
               share[1] * (1 - old) + rest[from_V2]};
  two.amperes = {-(share[0] * kept) / (1 - kept) - rest[from_i] / m.resistance_ohm,
                 (share[0] - share[1] * kept) / (1 - kept), share[1] / (1 - kept)};

  // Currents and turns are four, as are V_1, V_2, ω_0 and τ beside i_0 and V_0.
  Eigen::Matrix<double, 4, 6> seen;
  seen << middle.current, end.current, middle.angle, end.angle - middle.angle;
  const Eigen::RowVector4d load = seen.rightCols<4>().inverse().row(3);
  const double torque = m.torque_Nm_per_A * m.gear_ratio;
  two.drives = {-load.dot(seen.col(from_i).transpose()) / torque, load[0] / torque,
                load[1] / torque};
  two.drives_per_V = -load.dot(seen.col(from_V0).transpose()) / torque;
  two.drives_per_speed = (load[2] + load[3]) * period_s / torque;
  two.inertia_kg_m2 = (load[2] - load[3]) / 2 * period_s * period_s;
  return two;
}

const TwoPeriods& TwoPeriodsAt::ohm(double ohm) {
  if (ohm > 0 && std::abs(ohm - motor_.resistance_ohm) > 1e-3 * motor_.resistance_ohm) {
    motor_.resistance_ohm = ohm;
    two_ = two_periods(motor_, period_s_, late_s_);
  }
  return two_;
}

}  // namespace sim::residuals
