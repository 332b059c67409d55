#include "sim/diagnosis/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/actuator/sensors.hpp"

namespace sim::diagnosis {
namespace {

constexpr double coarse = 1.8;     // times the data sheet's step; chosen
constexpr std::size_t fewest = 8;  // different readings; chosen

void add(std::vector<effects::Placed>& all, const char* type, const std::string& on, double step,
         double finest) {
  if (!(step > coarse * finest)) return;
  effects::Placed placed{on, *effects::neutral(type)};
  const effects::Parameter parameter = effects::parameters(placed.effect)[0];
  *parameter.value = std::min(step, parameter.bounds.high);
  all.push_back(placed);
}

/// 1: all values are multiples of s but for a common offset.
double in_step(const std::vector<double>& values, double s) {
  double c = 0, i = 0;
  for (const double v : values) {
    const double phase = 2 * std::numbers::pi * v / s;
    c += std::cos(phase), i += std::sin(phase);
  }
  return std::hypot(c, i) / static_cast<double>(values.size());
}

/// How well n readings must be in step that chance would seldom do it: anywhere over a length L
/// they are as much as r with a probability of exp(−n r²), and steps s₀ … s₁ hold (s₁ − s₀) L/s² that
/// differ.
double beyond_chance(std::size_t n, double length, double steps_wide, double s) {
  constexpr double chance = 2e-3;  // chosen: eight readings that are wholly in step are believed
  const double tries = std::max(1.0, steps_wide * length / (s * s));
  return std::sqrt(std::log(tries / chance) / static_cast<double>(n));
}

}  // namespace

double lattice_step(std::span<const residuals::Signal* const> readings, double finest) {
  std::vector<double> values;
  for (const residuals::Signal* signal : readings)
    for (const double v : *signal)
      if (!std::isnan(v)) values.push_back(std::round(v / finest));
  std::ranges::sort(values);
  const auto repeats = std::ranges::unique(values);
  values.erase(repeats.begin(), repeats.end());
  if (values.size() < fewest) return 0;
  std::vector<double> gaps;
  for (std::size_t k = 1; k < values.size(); ++k) gaps.push_back(values[k] - values[k - 1]);
  std::ranges::sort(gaps);
  // A few strays, of samples that were interpolated, are passed over.
  const double guess = gaps[gaps.size() / 20];
  if (guess < 2) return guess * finest;
  // Far off, a step that is a little wrong is whole steps wrong: only so many are looked at.
  constexpr double steps = 500, of_a_step = 0.1;
  const double last = values[values.size() / 3] + steps * guess;
  values.erase(std::ranges::upper_bound(values, last), values.end());
  values.erase(values.begin(), std::ranges::lower_bound(values, last - steps * guess));
  if (values.size() < fewest) return finest;
  double best = 0, step = finest;
  const double narrowest = guess - 1, widest = guess + 1.5;
  for (double s = narrowest; s < widest; s += of_a_step / steps * guess)
    if (const double fits = in_step(values, s); fits > best) best = fits, step = s * finest;
  constexpr double least = 0.7;  // of 1; strays and rounding leave more; chosen
  const double convincing = std::max(
      least,
      beyond_chance(values.size(), values.back() - values.front(), widest - narrowest, guess));
  return best > convincing ? step : finest;
}

std::vector<effects::Placed> coarse_sensors(std::span<const residuals::Episode> episodes,
                                            const erp::Robot& robot) {
  std::vector<effects::Placed> all;
  const auto step = [&](auto signal_of, double finest) {
    std::vector<const residuals::Signal*> readings;
    for (const residuals::Episode& e : episodes) readings.push_back(&signal_of(e));
    return lattice_step(readings, finest);
  };
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const erp::Actuator& actuator = robot.actuators[a];
    const SensorScale scale(robot.motor_of(actuator), robot.sensors_of(actuator));
    const auto look = [&](const char* type, residuals::Signal residuals::ActuatorSignals::*signal,
                          double finest) {
      const auto of = [&](const residuals::Episode& e) -> const residuals::Signal& {
        return e.actuators[a].*signal;
      };
      add(all, type, actuator.name, step(of, finest), finest);
    };
    look("sensor_shaft_quantisation", &residuals::ActuatorSignals::shaft_rad,
         scale.shaft_rad_per_count);
    look("sensor_current_quantisation", &residuals::ActuatorSignals::current_A,
         scale.current_A_per_count);
    look("sensor_tension_quantisation", &residuals::ActuatorSignals::tension_N,
         scale.tension_N_per_count);
  }
  const auto joints = robot.joints();
  for (const erp::JointSensor& sensor : robot.joint_sensors)
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (joints[j].name != sensor.joint || joints[j].type != erp::JointType::revolute) continue;
      const double finest = 2 * std::numbers::pi / std::exp2(sensor.bits_per_rev);
      const auto of = [&](const residuals::Episode& e) -> const residuals::Signal& {
        return e.joints[j].angle_rad;
      };
      add(all, "sensor_joint_quantisation", sensor.joint, step(of, finest), finest);
    }
  return all;
}

}  // namespace sim::diagnosis
