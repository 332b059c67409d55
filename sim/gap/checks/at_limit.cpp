#include "sim/gap/checks/at_limit.hpp"

#include <cmath>

#include "sim/gap/residuals/drives.hpp"
#include "sim/model/actuator/sensors.hpp"

namespace sim::checks {
namespace {

using residuals::Column, residuals::Quantity, residuals::Signal;

constexpr double much = 0.02;  // of the rows; chosen

/// How often it is at least so large, of the rows that were taken.
double share_beyond(const Signal& signal, double limit) {
  double beyond = 0, taken = 0;
  for (const double x : signal)
    if (std::isfinite(x)) beyond += std::abs(x) >= limit, ++taken;
  return taken > 0 ? beyond / taken : 0;
}

}  // namespace

std::vector<AtLimit> at_limit(const residuals::Episode& episode, const erp::Robot& robot) {
  std::vector<AtLimit> all;
  const auto look = [&](const Column& column, const Signal& signal, int counts, double per_count) {
    const double share = share_beyond(signal, (counts - 0.5) * per_count);
    if (share > much) all.push_back({column, counts * per_count, share});
  };
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const erp::Actuator& actuator = robot.actuators[a];
    if (residuals::drive_of(robot, actuator.name)) continue;  // its converters are not described
    const SensorScale scale(robot.motor_of(actuator), robot.sensors_of(actuator));
    const residuals::ActuatorSignals& measured = episode.actuators[a];
    look({Quantity::current, a}, measured.current_A, scale.current_counts_max,
         scale.current_A_per_count);
    look({Quantity::tension, a}, measured.tension_N,
         scale.tension_counts_max - scale.tension_zero_counts, scale.tension_N_per_count);
  }
  return all;
}

}  // namespace sim::checks
