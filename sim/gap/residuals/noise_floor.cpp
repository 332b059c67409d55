#include "sim/gap/residuals/noise_floor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/gap/residuals/signal_noise.hpp"
#include "sim/model/actuator/noise.hpp"
#include "sim/model/actuator/sensors.hpp"

namespace sim::residuals {
namespace {

constexpr double current_gain_error = 0.003;  // of a good current sensor; chosen
// Of an amplifier; for currents that are computed from the voltage; chosen.
constexpr double voltage_gain_error = 3e-4;

void disturb(Signal& signal, double noise_rms, Noise& noise) {
  for (double& x : signal) x += noise_rms * noise.normal();
}

/// The step of a quantization effect on a sensor, or 0.
double coarse_step(const std::vector<effects::Placed>& all, const char* type,
                   const std::string& on) {
  for (effects::Placed placed : all)
    if (effects::about(placed.effect).type == type && placed.on == on)
      return *effects::parameters(placed.effect)[0].value;
  return 0;
}

/// Adds another realization of a sensor's noise and quantization error, with a random shift u of
/// its steps:
///
///   e = step (⌊(x + n)/step + u⌉ − u) − x,   x: the signal smoothed, n ~ N(0, rms²), u ~ U(0, 1)
///
/// If the noise is smaller than a step, the error is not white noise: it is constant while the
/// signal is constant.
void requantize(Signal& signal, double noise_rms, double step, Noise& noise) {
  if (!(step > 0)) return disturb(signal, noise_rms, noise);
  constexpr std::size_t reach = 12;  // rows to each side of the smoothing window; chosen
  const Signal original = signal;
  const double shift = noise.uniform();
  for (std::size_t k = 0; k < original.size(); ++k) {
    double sum = 0, count = 0;
    for (std::size_t n = k < reach ? 0 : k - reach; n < std::min(original.size(), k + reach + 1);
         ++n)
      if (!std::isnan(original[n])) sum += original[n], ++count;
    if (count == 0 || std::isnan(original[k])) continue;
    const double smooth = sum / count, noisy = smooth + noise_rms * noise.normal();
    signal[k] = original[k] + step * (std::round(noisy / step + shift) - shift) - smooth;
  }
}

/// Delays the samples by half a period, like a low-pass amplifier.
void delay(Signal& signal) {
  constexpr double delay_periods = 0.5;
  const Signal original = signal;
  for (std::size_t k = 1; k + 1 < original.size(); ++k)
    signal[k] = original[k] - delay_periods * (original[k + 1] - original[k - 1]) / 2;
}

/// Shifts each row by a random delay, common to all signals.
void disturb_times(Episode& e, Noise& noise) {
  Signal delay_s(e.rows);
  for (double& t : delay_s) t = e.jitter_s * noise.uniform();
  const auto disturb = [&](Signal& signal) {
    const Signal original = signal;
    for (std::size_t k = 0; k < signal.size(); ++k)
      signal[k] += rate_of(original, k, e.period_s) * delay_s[k];
  };
  for (ActuatorSignals& s : e.actuators)
    disturb(s.voltage_V), disturb(s.current_A), disturb(s.shaft_rad), disturb(s.tension_N);
  for (JointSignals& j : e.joints) {
    disturb(j.angle_rad);
    for (Signal& part : j.quaternion) disturb(part);
  }
}

/// Applies the deviations that no data sheet excludes: delayed tensions and a gain error of
/// currents.
void apply_unspecified_errors(Episode& e) {
  for (ActuatorSignals& s : e.actuators) {
    delay(s.tension_N);
    for (double& i : s.current_A) i *= 1 + current_gain_error;
    if (s.current_A.empty())
      for (double& v : s.voltage_V) v *= 1 + voltage_gain_error;
  }
}

/// Adds the sensors' noise and quantization.
void disturb(Episode& noisy, const erp::Robot& robot, std::uint64_t seed) {
  Noise noise(seed);
  if (noisy.jitter_s > 0) disturb_times(noisy, noise);
  const auto coarse = effects::read_effects(robot);
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const erp::SensorType& sensors = robot.sensors_of(robot.actuators[a]);
    const SensorScale scale(robot.motor_of(robot.actuators[a]), sensors);
    ActuatorSignals& s = noisy.actuators[a];
    const bool has_encoder_step = sensors.encoder_counts_per_rev > 0;  // false for some drives
    if (has_encoder_step) requantize(s.shaft_rad, 0, scale.shaft_rad_per_count, noise);
    else disturb(s.shaft_rad, noise_of(s.shaft_rad), noise);
    requantize(s.current_A, sensors.current_noise_A, scale.current_A_per_count, noise);
    const bool is_drive = robot.actuators[a].tendon.path.empty();
    const double tension_noise =
        is_drive && sensors.tension_noise_N == 0 ? noise_of(s.tension_N) : sensors.tension_noise_N;
    requantize(s.tension_N, tension_noise, scale.tension_N_per_count, noise);
    const auto coarsen = [&](const char* type, Signal& signal) {
      if (const double step = coarse_step(coarse, type, robot.actuators[a].name); step > 0)
        requantize(signal, 0, step, noise);
    };
    coarsen("sensor_shaft_quantisation", s.shaft_rad);
    coarsen("sensor_current_quantisation", s.current_A);
    coarsen("sensor_tension_quantisation", s.tension_N);
  }
  const auto joints = robot.joints();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    JointSignals& signals = noisy.joints[j];
    const auto sensor =
        std::ranges::find(robot.joint_sensors, joints[j].name, &erp::JointSensor::joint);
    if (sensor != robot.joint_sensors.end() && joints[j].type == erp::JointType::revolute) {
      const double finest = 2 * std::numbers::pi / std::exp2(sensor->bits_per_rev);
      requantize(signals.angle_rad, sensor->noise_rad, finest, noise);
      if (const double step = coarse_step(coarse, "sensor_joint_quantisation", sensor->joint);
          step > 0)
        requantize(signals.angle_rad, 0, step, noise);
      continue;
    }
    disturb(signals.angle_rad, noise_of(signals.angle_rad), noise);
    for (Signal& part : signals.quaternion) disturb(part, noise_of(part), noise);
  }
}

/// The change of one residual by a change of the recording, at each window. NaN if it may be hidden
/// by a band.
Signal change_of(const Residual& before, const Residual& after) {
  Signal change;
  for (std::size_t k = 0; k < before.value.size(); ++k)
    change.push_back(banded(before, k) || banded(after, k) ? recording::not_taken
                                                           : after.value[k] - before.value[k]);
  return change;
}

}  // namespace

Episode resampled_noise(const Episode& episode, const erp::Robot& robot, std::uint64_t seed) {
  Episode noisy = episode;
  apply_unspecified_errors(noisy);
  disturb(noisy, robot, seed);
  return noisy;
}

std::vector<Floor> floors(Stages& stages, const Episode& episode, const erp::Robot& robot,
                          std::uint64_t seed) {
  Episode noisy = episode, deviating = episode;
  disturb(noisy, robot, seed), apply_unspecified_errors(deviating);
  const auto nominal = stages.residuals(episode), noise = stages.residuals(noisy),
             deviations = stages.residuals(deviating);
  std::vector<Floor> floors;
  for (std::size_t r = 0; r < nominal.size(); ++r) {
    const double by_noise = rms(change_of(nominal[r], noise[r]));
    const Signal by_deviation = change_of(nominal[r], deviations[r]);
    Floor floor{std::hypot(by_noise, rms(by_deviation)), {}};
    for (const double d : by_deviation)
      floor.by_window.push_back(std::isnan(d) ? floor.rms
                                              : std::max(floor.rms, std::hypot(by_noise, d)));
    floors.push_back(std::move(floor));
  }
  return floors;
}

}  // namespace sim::residuals
