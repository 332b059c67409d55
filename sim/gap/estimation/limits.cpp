#include "sim/gap/estimation/limits.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "interfaces/recording/table.hpp"
#include "sim/gap/residuals/drives.hpp"
#include "sim/model/actuator/sensors.hpp"

namespace sim::estimation {
namespace {

using residuals::ActuatorSignals;
using residuals::Signal;

constexpr double near_limit = 0.97;  // of a current limit; chosen
constexpr double min_excess_current =
    0.1;  // of the current without a limit, relative to i_max; chosen

std::size_t clip_to_supply(const erp::MotorType& motor, Signal& voltage_V) {
  std::size_t clipped = 0;
  for (double& v : voltage_V)
    if (std::abs(v) > motor.supply_V) v = std::copysign(motor.supply_V, v), ++clipped;
  return clipped;
}

/// Sets voltage and current to NaN around rows at which the driver limits the current. Returns the
/// number of rows.
std::size_t remove_limited(const erp::MotorType& motor, double period_s, ActuatorSignals& s) {
  if (s.current_A.empty() || s.shaft_rad.empty() || s.voltage_V.empty()) return 0;
  const double back_emf = motor.back_emf_V_s_per_rad * motor.gear_ratio;
  const auto is_limited = [&](std::size_t k) {
    const double i = s.current_A[k], direction = i > 0 ? 1 : -1;
    const double unlimited_A =
        direction * (s.voltage_V[k] - back_emf * residuals::rate_of(s.shaft_rad, k, period_s)) /
        motor.resistance_ohm;
    return std::abs(i) >= near_limit * motor.current_limit_A &&
           unlimited_A > (1 + min_excess_current) * motor.current_limit_A;
  };
  std::vector<std::size_t> rows;
  for (std::size_t k = 1; k + 1 < s.voltage_V.size(); ++k)
    if (is_limited(k)) rows.push_back(k);
  for (const std::size_t k : rows)  // and the rows before and after
    for (std::size_t n = k - 1; n <= k + 1; ++n)
      s.voltage_V[n] = s.current_A[n] = recording::not_taken;
  return rows.size();
}

std::size_t remove_beyond(Signal& signal, double low, double high) {
  std::size_t removed = 0;
  for (double& x : signal)
    if (x <= low || x >= high) x = recording::not_taken, ++removed;
  return removed;
}

}  // namespace

void apply_limits(const erp::Robot& robot, std::vector<residuals::Episode>& episodes,
                  std::vector<std::string>& remarks) {
  for (residuals::Episode& e : episodes)
    for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
      const erp::Actuator& actuator = robot.actuators[a];
      if (residuals::drive_of(robot, actuator.name)) continue;  // no converters specified
      const erp::MotorType& motor = robot.motor_of(actuator);
      const SensorScale scale(motor, robot.sensors_of(actuator));
      ActuatorSignals& s = e.actuators[a];
      if (const std::size_t rows = clip_to_supply(motor, s.voltage_V); rows > 0)
        remarks.push_back(
            fmt::format("{}: {}.voltage_V is above the supply of {:g} V in {} rows; the "
                        "supply voltage is used there",
                        e.name, actuator.name, motor.supply_V, rows));
      if (const std::size_t rows = remove_limited(motor, e.period_s, s); rows > 0)
        remarks.push_back(
            fmt::format("{}: {} is at its current limit of {:g} A in {} rows: voltage and current "
                        "between rows are "
                        "unknown there; motor and gearbox are not judged in these rows",
                        e.name, actuator.name, motor.current_limit_A, rows));
      const double max_A = (scale.current_counts_max - 0.5) * scale.current_A_per_count;
      if (const std::size_t rows = remove_beyond(s.current_A, -max_A, max_A); rows > 0)
        remarks.push_back(
            fmt::format("{}: {}.current_A is at the end of its range in {} rows; these samples are "
                        "ignored",
                        e.name, actuator.name, rows));
      const double max_N =
          (scale.tension_counts_max - scale.tension_zero_counts - 0.5) * scale.tension_N_per_count;
      if (const std::size_t rows =
              remove_beyond(s.tension_N, -std::numeric_limits<double>::infinity(), max_N);
          rows > 0)
        remarks.push_back(
            fmt::format("{}: {}.tension_N is at the end of its range in {} rows; these samples are "
                        "ignored",
                        e.name, actuator.name, rows));
    }
}

}  // namespace sim::estimation
