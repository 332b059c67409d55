#include "sim/gap/checks/at_limit.hpp"

#include <cmath>

#include "sim/gap/residuals/drives.hpp"
#include "sim/model/actuator/sensors.hpp"

namespace sim::checks {
namespace {

using residuals::Column, residuals::Quantity, residuals::Signal;

constexpr double smallest_share = 0.02;  // of the rows; chosen

/// Share of the valid rows in which the magnitude is at least `limit`.
double share_beyond(const Signal& signal, double limit) {
  double beyond = 0, valid = 0;
  for (const double x : signal)
    if (std::isfinite(x)) beyond += std::abs(x) >= limit, ++valid;
  return valid > 0 ? beyond / valid : 0;
}

}  // namespace

std::vector<AtLimit> at_limit(const residuals::Episode& episode, const erp::Robot& robot) {
  std::vector<AtLimit> all;
  const auto add_if_at_limit = [&](const Column& column, const Signal& signal, int counts,
                                   double per_count) {
    const double share = share_beyond(signal, (counts - 0.5) * per_count);
    if (share > smallest_share) all.push_back({column, counts * per_count, share});
  };
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const erp::Actuator& actuator = robot.actuators[a];
    if (residuals::drive_of(robot, actuator.name)) continue;  // its converters are not described
    const SensorScale scale(robot.motor_of(actuator), robot.sensors_of(actuator));
    const residuals::ActuatorSignals& measured = episode.actuators[a];
    add_if_at_limit({Quantity::current, a}, measured.current_A, scale.current_counts_max,
                    scale.current_A_per_count);
    add_if_at_limit({Quantity::tension, a}, measured.tension_N,
                    scale.tension_counts_max - scale.tension_zero_counts,
                    scale.tension_N_per_count);
  }
  return all;
}

}  // namespace sim::checks
