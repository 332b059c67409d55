#include "sim/gap/residuals/chain_residuals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/gap/residuals/held_voltage.hpp"

namespace sim::residuals {
namespace {

constexpr double no_residual = std::numeric_limits<double>::quiet_NaN();

/// A chain and the window of its residuals.
struct Chain {
  const ChainTrace& trace;
  const erp::MotorType& motor;
  double period_s;
  const Bump& bump;
};

/// V − R i − L di/dt over the two periods around each row. By the motor's law it equals K_E N
/// (θ_k+1 − θ_k−1)/2T.
Signal induced_V(const Chain& c) {
  const ChainTrace& t = c.trace;
  const double a = t.current_averaged;
  TwoPeriodsAt two(c.motor, c.period_s, t.driver_delay_s);
  const double delay = t.driver_delay_s / c.period_s;  // in periods
  Signal induced(t.terminal_V.size(), no_residual);
  for (std::size_t k = 1; k + 1 < induced.size(); ++k) {
    const double first_V = t.terminal_V[k - 1], middle_V = t.terminal_V[k],
                 last_V = t.terminal_V[k + 1];
    const double ohm = t.resistance_ohm[k], before = t.current_A[k - 1], now = t.current_A[k],
                 next = t.current_A[k + 1];
    const auto& [volts, amperes, drives, per_V, per_speed, inertia] = two.at(ohm);
    const double sampled = (delay > 0 ? volts[0] * first_V : 0) + volts[1] * middle_V +
                           volts[2] * last_V -
                           ohm * (amperes[0] * before + amperes[1] * now + amperes[2] * next);
    const double mean_V =
        (delay > 0 ? delay * first_V : 0) / 2 + (middle_V + (1 - delay) * last_V) / 2;
    const double around_row =
        mean_V - ohm * now - c.motor.inductance_H * (next - before) / (2 * c.period_s);
    induced[k] = (1 - a) * sampled + a * around_row;
  }
  return induced;
}

std::vector<double> motor_V(const Chain& c, std::span<const std::size_t> rows) {
  const Signal induced = induced_V(c);
  const double back_emf = c.motor.back_emf_V_s_per_rad * c.motor.gear_ratio;
  std::vector<double> value;
  for (const std::size_t k : rows)
    value.push_back(c.bump.mean(induced, k) - back_emf * c.bump.rate(c.trace.shaft_rad, k));
  return value;
}

/// Sets the values of the gearbox's residual. In windows in which the shaft reverses, the value is
/// the part beyond the uncertainty.
void add_gearbox(const Chain& c, std::span<const std::size_t> rows, Residual& residual) {
  const double viscous =
      c.motor.rotor_viscous_Nm_s_per_rad * c.motor.gear_ratio * c.motor.gear_ratio;
  const double a = c.trace.current_averaged, total_inertia = shaft_inertia_kg_m2(c.motor);
  TwoPeriodsAt two(c.motor, c.period_s, c.trace.driver_delay_s);
  for (const std::size_t k : rows) {
    const double ohm = c.trace.resistance_ohm.empty() ? c.motor.resistance_ohm
                                                      : c.bump.mean(c.trace.resistance_ohm, k);
    const double inertia = (1 - a) * two.at(ohm).inertia_kg_m2 + a * total_inertia;
    const double residual_Nm = inertia * c.bump.acceleration(c.trace.shaft_rad, k) +
                               viscous * c.bump.rate(c.trace.shaft_rad, k) -
                               c.bump.mean(c.trace.drive_Nm, k);
    const double uncertainty = c.bump.mean(c.trace.uncertainty_Nm, k);
    residual.value.push_back(
        std::isnan(residual_Nm)
            ? no_residual
            : std::copysign(std::max(0.0, std::abs(residual_Nm) - uncertainty), residual_Nm));
    residual.band.push_back(uncertainty);
  }
}

std::vector<double> tendon_N(const Chain& c, std::span<const std::size_t> rows) {
  std::vector<double> value;
  for (const std::size_t k : rows)
    value.push_back(c.bump.mean(c.trace.tension_N, k) - c.bump.mean(c.trace.spring_N, k));
  return value;
}

double input_rms(const Chain& c, const Signal& driver, std::span<const std::size_t> rows) {
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
  std::vector<Residual> residuals;
  if (trace.current_measured && !trace.terminal_V.empty())
    residuals.push_back({effects::Stage::motor, actuator.name, "V", motor_V(chain, rows),
                         input_rms(chain, trace.terminal_V, rows)});
  if (!trace.drive_Nm.empty()) {
    residuals.push_back(
        {effects::Stage::gearbox, actuator.name, "Nm", {}, input_rms(chain, trace.motor_Nm, rows)});
    add_gearbox(chain, rows, residuals.back());
  }
  if (trace.tension_measured && !trace.spring_N.empty())
    residuals.push_back({effects::Stage::tendon, actuator.name, "N", tendon_N(chain, rows),
                         input_rms(chain, trace.tension_N, rows)});
  return residuals;
}

}  // namespace sim::residuals
