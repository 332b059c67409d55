#include "sim/residuals/chain_residuals.hpp"

#include <cmath>
#include <limits>

#include "sim/residuals/held_voltage.hpp"

namespace sim::residuals {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Chain {
  const ChainTrace& trace;
  const erp::MotorType& motor;
  double period_s;
  const Bump& bump;
};

/// V − R i at the end of each period, without the current's start within it.
Signal settled_V(const Chain& c) {
  const ChainTrace& t = c.trace;
  Signal left(t.terminal_V.size(), nan);
  for (std::size_t k = 1; k < left.size(); ++k) {
    // of the current before, so much is left at the end of a period
    const double kept = std::exp(-c.period_s * t.resistance_ohm[k] / c.motor.inductance_H);
    const double settled_A = (t.current_A[k] - kept * t.current_A[k - 1]) / (1 - kept);
    left[k] = t.terminal_V[k] - t.resistance_ohm[k] * settled_A;
  }
  return left;
}

/// V − R i over each period: what K_E N (θ_k − θ_k−1)/T answers to.
Signal over_period_V(const Chain& c) {
  const Signal settled = settled_V(c);
  Signal left(settled.size(), nan);
  erp::MotorType motor = c.motor;
  double d = earlier_share(motor, c.period_s);
  for (std::size_t k = 1; k < left.size(); ++k) {
    const double ohm = c.trace.resistance_ohm[k];
    if (ohm != motor.resistance_ohm && ohm > 0)
      motor.resistance_ohm = ohm, d = earlier_share(motor, c.period_s);
    left[k] = (1 - d) * settled[k] + d * settled[k - 1];
  }
  return left;
}

/// V − R i − L di/dt over the two periods around each row: what K_E N (θ_k+1 − θ_k−1)/2T answers to.
Signal around_V(const Chain& c) {
  const ChainTrace& t = c.trace;
  const Signal over = over_period_V(c);
  const double a = t.current_averaged;
  Signal left(over.size(), nan);
  for (std::size_t k = 1; k + 1 < left.size(); ++k) {
    const double rise_A_per_s = (t.current_A[k + 1] - t.current_A[k - 1]) / (2 * c.period_s);
    const double averaged = (t.terminal_V[k] + t.terminal_V[k + 1]) / 2 -
                            t.resistance_ohm[k] * t.current_A[k] -
                            c.motor.inductance_H * rise_A_per_s;
    left[k] = (1 - a) * (over[k] + over[k + 1]) / 2 + a * averaged;
  }
  return left;
}

std::vector<double> motor_V(const Chain& c, std::span<const std::size_t> rows) {
  const Signal left = around_V(c);
  const double back_emf = c.motor.back_emf_V_s_per_rad * c.motor.gear_ratio;
  std::vector<double> value;
  for (const std::size_t k : rows)
    value.push_back(c.bump.mean(left, k) - back_emf * c.bump.rate(c.trace.shaft_rad, k));
  return value;
}

std::vector<double> gearbox_Nm(const Chain& c, std::span<const std::size_t> rows) {
  erp::MotorType motor = c.motor;
  const double viscous = motor.rotor_viscous_Nm_s_per_rad * motor.gear_ratio * motor.gear_ratio;
  std::vector<double> value;
  for (const std::size_t k : rows) {
    if (!c.trace.resistance_ohm.empty())
      motor.resistance_ohm = c.bump.mean(c.trace.resistance_ohm, k);
    value.push_back(balance_inertia(motor, c.period_s, 1 - c.trace.current_averaged) *
                        c.bump.acceleration(c.trace.shaft_rad, k) +
                    viscous * c.bump.rate(c.trace.shaft_rad, k) - c.bump.mean(c.trace.drive_Nm, k));
  }
  return value;
}

std::vector<double> tendon_N(const Chain& c, std::span<const std::size_t> rows) {
  std::vector<double> value;
  for (const std::size_t k : rows)
    value.push_back(c.bump.mean(c.trace.tension_N, k) - c.bump.mean(c.trace.spring_N, k));
  return value;
}

double driven_by(const Chain& c, const Signal& driver, std::span<const std::size_t> rows) {
  double square = 0, count = 0;
  for (const std::size_t k : rows)
    if (const double x = c.bump.mean(driver, k); !std::isnan(x)) square += x * x, ++count;
  return count > 0 ? std::sqrt(square / count) : 0;
}

}  // namespace

std::vector<Residual> chain_residuals(const ChainTrace& trace, const erp::Actuator& actuator,
                                      const erp::MotorType& motor, const Episode& episode,
                                      const Bump& bump, std::span<const std::size_t> rows) {
  const Chain chain{trace, motor, episode.period_s, bump};
  std::vector<Residual> all;
  if (trace.current_measured && !trace.terminal_V.empty())
    all.push_back({effects::Stage::motor, actuator.name, "V", motor_V(chain, rows),
                   driven_by(chain, trace.terminal_V, rows)});
  if (!trace.drive_Nm.empty())
    all.push_back({effects::Stage::gearbox, actuator.name, "Nm", gearbox_Nm(chain, rows),
                   driven_by(chain, trace.motor_Nm, rows)});
  if (trace.tension_measured && !trace.spring_N.empty())
    all.push_back({effects::Stage::tendon, actuator.name, "N", tendon_N(chain, rows),
                   driven_by(chain, trace.tension_N, rows)});
  return all;
}

}  // namespace sim::residuals
