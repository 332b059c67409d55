#include "sim/gap/diagnosis/quantization_step.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/model/actuator/sensors.hpp"

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
  const double initial_guesses = std::max(1.0, steps_wide * length / (s * s));
  return std::sqrt(std::log(initial_guesses / chance) / static_cast<double>(n));
}

/// Different readings in ascending order, in units of the finest step.
std::vector<double> distinct(std::span<const residuals::Signal* const> readings, double finest) {
  std::vector<double> values;
  for (const residuals::Signal* signal : readings)
    for (const double v : *signal)
      if (!std::isnan(v)) values.push_back(std::round(v / finest));
  std::ranges::sort(values);
  const auto repeats = std::ranges::unique(values);
  values.erase(repeats.begin(), repeats.end());
  return values;
}

/// Readings near one another, and how well they must be in step.
struct Stretch {
  std::vector<double> values;
  double convincing;
};

/// Which steps are looked for, in units of the finest.
struct Steps {
  double guess;
  double narrowest() const { return guess - 1; }
  double widest() const { return guess + 1.5; }
};

/// Some from all over the range, `length` steps each: further off, a step that is a little wrong is whole steps wrong.
/// Several, since while a motion is uniform its readings are evenly apart, each time by another step.
std::vector<Stretch> stretches(const std::vector<double>& values, Steps steps, double length) {
  constexpr std::size_t most = 5;  // chosen
  constexpr double least = 0.7;    // of 1; strays and rounding leave more; chosen
  std::vector<Stretch> all, some;
  for (auto from = values.begin(); from != values.end();) {
    const auto to = std::upper_bound(from, values.end(), *from + length * steps.guess);
    if (std::size_t(to - from) >= fewest)
      all.push_back(
          {{from, to},
           std::max(least, beyond_chance(std::size_t(to - from), *(to - 1) - *from,
                                         steps.widest() - steps.narrowest(), steps.guess))});
    from = to;
  }
  const std::size_t count = std::min(most, all.size());
  for (std::size_t k = 0; k < count; ++k) some.push_back(all[k * all.size() / count]);
  return some;
}

/// Summed over stretches, each with an offset of its own; 0: one of them is not in step.
double in_step(const std::vector<Stretch>& all, double s) {
  double sum = 0;
  for (const Stretch& one : all) {
    const double here = in_step(one.values, s);
    if (here <= one.convincing) return 0;
    sum += here;
  }
  return sum;
}

}  // namespace

double quantization_step(std::span<const residuals::Signal* const> readings, double finest) {
  const std::vector<double> values = distinct(readings, finest);
  if (values.size() < fewest) return 0;
  std::vector<double> gaps;
  for (std::size_t k = 1; k < values.size(); ++k) gaps.push_back(values[k] - values[k - 1]);
  std::ranges::sort(gaps);
  // A few strays, of samples that were interpolated, are passed over.
  const Steps steps{gaps[gaps.size() / 20]};
  if (steps.guess < 2) return steps.guess * finest;
  constexpr double length = 500, of_a_step = 0.1;
  const std::vector<Stretch> all = stretches(values, steps, length);
  double best = 0, step = finest;
  for (double s = steps.narrowest(); s < steps.widest(); s += of_a_step / length * steps.guess)
    if (const double fits = in_step(all, s); fits > best) best = fits, step = s * finest;
  return step;
}

std::vector<effects::Placed> coarse_sensors(std::span<const residuals::Episode> episodes,
                                            const erp::Robot& robot) {
  std::vector<effects::Placed> all;
  const auto step = [&](auto signal_of, double finest) {
    std::vector<const residuals::Signal*> readings;
    for (const residuals::Episode& e : episodes) readings.push_back(&signal_of(e));
    return quantization_step(readings, finest);
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
