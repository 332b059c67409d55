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

/// Coherence of the values with step s: 1 if all are multiples of s plus a common offset.
double coherence(const std::vector<double>& values, double s) {
  double c = 0, i = 0;
  for (const double v : values) {
    const double phase = 2 * std::numbers::pi * v / s;
    c += std::cos(phase), i += std::sin(phase);
  }
  return std::hypot(c, i) / static_cast<double>(values.size());
}

/// Coherence that n random readings over a length L seldom reach. They reach r with probability exp(−n r²) for one
/// step; the range s₀ … s₁ contains (s₁ − s₀) L/s² independent steps.
double significant_coherence(std::size_t n, double length, double steps_wide, double s) {
  constexpr double chance = 2e-3;  // chosen: eight readings in perfect step are significant
  const double independent_steps = std::max(1.0, steps_wide * length / (s * s));
  return std::sqrt(std::log(independent_steps / chance) / static_cast<double>(n));
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

/// Readings in a short range, and the coherence that is significant for them.
struct Stretch {
  std::vector<double> values;
  double significant;
};

/// Range of the search for the step, in units of the finest.
struct Steps {
  double guess;
  double narrowest() const { return guess - 1; }
  double widest() const { return guess + 1.5; }
};

/// Stretches of `length` steps from all over the range. They are short because the phase error of a slightly wrong step
/// grows with the distance. Several are needed because readings of a uniform motion are equally spaced too, but with
/// another spacing in each stretch.
std::vector<Stretch> stretches(const std::vector<double>& values, Steps steps, double length) {
  constexpr std::size_t most = 5;  // chosen
  constexpr double least = 0.7;  // of 1; true steps exceed it despite outliers and rounding; chosen
  std::vector<Stretch> all, some;
  for (auto from = values.begin(); from != values.end();) {
    const auto to = std::upper_bound(from, values.end(), *from + length * steps.guess);
    if (std::size_t(to - from) >= fewest)
      all.push_back({{from, to},
                     std::max(least, significant_coherence(
                                         std::size_t(to - from), *(to - 1) - *from,
                                         steps.widest() - steps.narrowest(), steps.guess))});
    from = to;
  }
  const std::size_t count = std::min(most, all.size());
  for (std::size_t k = 0; k < count; ++k) some.push_back(all[k * all.size() / count]);
  return some;
}

/// Sum over stretches, each with its own offset. 0 if one of them is not coherent.
double coherence(const std::vector<Stretch>& all, double s) {
  double sum = 0;
  for (const Stretch& one : all) {
    const double here = coherence(one.values, s);
    if (here <= one.significant) return 0;
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
  // The smallest 5 % may be outliers from interpolated samples.
  const Steps steps{gaps[gaps.size() / 20]};
  if (steps.guess < 2) return steps.guess * finest;
  constexpr double length = 500, of_a_step = 0.1;
  const std::vector<Stretch> all = stretches(values, steps, length);
  double best = 0, step = finest;
  for (double s = steps.narrowest(); s < steps.widest(); s += of_a_step / length * steps.guess)
    if (const double fits = coherence(all, s); fits > best) best = fits, step = s * finest;
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
    const auto check = [&](const char* type, residuals::Signal residuals::ActuatorSignals::*signal,
                           double finest) {
      const auto of = [&](const residuals::Episode& e) -> const residuals::Signal& {
        return e.actuators[a].*signal;
      };
      add(all, type, actuator.name, step(of, finest), finest);
    };
    check("sensor_shaft_quantisation", &residuals::ActuatorSignals::shaft_rad,
          scale.shaft_rad_per_count);
    check("sensor_current_quantisation", &residuals::ActuatorSignals::current_A,
          scale.current_A_per_count);
    check("sensor_tension_quantisation", &residuals::ActuatorSignals::tension_N,
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
