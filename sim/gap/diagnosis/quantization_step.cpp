#include "sim/gap/diagnosis/quantization_step.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/model/actuator/sensors.hpp"

namespace sim::diagnosis {
namespace {

constexpr double coarse_ratio = 1.8;               // step / step of the data sheet; chosen
constexpr std::size_t min_different_readings = 8;  // chosen

void add(std::vector<effects::Placed>& all, const char* type, const std::string& on, double step,
         double finest) {
  if (!(step > coarse_ratio * finest)) return;
  effects::Placed placed{on, *effects::neutral(type)};
  const effects::Parameter parameter = effects::parameters(placed.effect)[0];
  *parameter.value = std::min(step, parameter.bounds.high);
  all.push_back(placed);
}

/// Coherence of values v with step s, |Σ e^(2πi v/s)|/n. It is 1 if all are multiples of s plus a
/// common offset.
double coherence(const std::vector<double>& values, double s) {
  double c = 0, i = 0;
  for (const double v : values) {
    const double phase = 2 * std::numbers::pi * v / s;
    c += std::cos(phase), i += std::sin(phase);
  }
  return std::hypot(c, i) / static_cast<double>(values.size());
}

/// Coherence that n random readings over a length L rarely reach. For one step they reach r with
/// probability exp(−n r²). The range s₀ … s₁ contains (s₁ − s₀) L/s² independent steps.
double significant_coherence(std::size_t n, double length, double range, double s) {
  constexpr double chance = 2e-3;  // chosen: eight readings with one exact step are significant
  const double independent_steps = std::max(1.0, range * length / (s * s));
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

/// Readings in a short interval, and the coherence that is significant for them.
struct ShortInterval {
  std::vector<double> values;
  double significant;
};

/// Range of the search for the step, in units of the finest step.
struct Steps {
  double guess;
  double narrowest() const { return guess - 1; }
  double widest() const { return guess + 1.5; }
};

/// Intervals of `length` steps, spread over the range of the readings. They are short because the
/// phase error of a slightly wrong step grows with the distance. Several are needed because
/// readings of a uniform motion are equally spaced too, but with another spacing in each interval.
std::vector<ShortInterval> short_intervals(const std::vector<double>& values, Steps steps,
                                           double length) {
  constexpr std::size_t max_count = 5;  // chosen
  constexpr double least_coherence =
      0.7;  // true steps exceed it despite outliers and rounding; chosen
  std::vector<ShortInterval> all, selected;
  for (auto begin = values.begin(); begin != values.end();) {
    const auto end = std::upper_bound(begin, values.end(), *begin + length * steps.guess);
    if (std::size_t(end - begin) >= min_different_readings)
      all.push_back(
          {{begin, end},
           std::max(least_coherence,
                    significant_coherence(std::size_t(end - begin), *(end - 1) - *begin,
                                          steps.widest() - steps.narrowest(), steps.guess))});
    begin = end;
  }
  const std::size_t count = std::min(max_count, all.size());
  for (std::size_t k = 0; k < count; ++k) selected.push_back(all[k * all.size() / count]);
  return selected;
}

/// Sum over the intervals, each with a separate offset. 0 if one of them is not coherent.
double coherence(const std::vector<ShortInterval>& all, double s) {
  double sum = 0;
  for (const ShortInterval& one : all) {
    const double one_coherence = coherence(one.values, s);
    if (one_coherence <= one.significant) return 0;
    sum += one_coherence;
  }
  return sum;
}

}  // namespace

double quantization_step(std::span<const residuals::Signal* const> readings, double finest) {
  const std::vector<double> values = distinct(readings, finest);
  if (values.size() < min_different_readings) return 0;
  std::vector<double> gaps;
  for (std::size_t k = 1; k < values.size(); ++k) gaps.push_back(values[k] - values[k - 1]);
  std::ranges::sort(gaps);
  // The smallest 5 % may be outliers from interpolated samples.
  const Steps steps{gaps[gaps.size() / 20]};
  if (steps.guess < 2) return steps.guess * finest;
  constexpr double length = 500;             // of an interval, in steps; chosen
  constexpr double search_resolution = 0.1;  // phase error at the end of an interval; chosen
  const std::vector<ShortInterval> all = short_intervals(values, steps, length);
  double best = 0, step = finest;
  for (double s = steps.narrowest(); s < steps.widest();
       s += search_resolution / length * steps.guess)
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
