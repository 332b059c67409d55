#include "sim/gap/residuals/noise_floor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/gap/residuals/signal_noise.hpp"
#include "sim/model/actuator/noise.hpp"
#include "sim/model/actuator/sensors.hpp"

namespace sim::residuals {
namespace {

constexpr double calibration = 0.003;  // of a current sensor at its best; chosen
constexpr double of_voltage = 3e-4;    // of an amplifier's where it stands for a current; chosen

void disturb(Signal& signal, double noise_rms, Noise& noise) {
  for (double& x : signal) x += noise_rms * noise.normal();
}

/// The step of an effect on a sensor, or 0.
double coarse_step(const std::vector<effects::Placed>& all, const char* type,
                   const std::string& on) {
  for (effects::Placed placed : all)
    if (effects::about(placed.effect).type == type && placed.on == on)
      return *effects::parameters(placed.effect)[0].value;
  return 0;
}

/// The error of a sensor with noise and steps, once more with its lattice elsewhere:
///
///   e = step (⌊(x + n)/step + u⌉ − u) − x,   x: the signal smoothed, n ~ N(0, rms²), u ~ U(0, 1)
///
/// Where noise is less than a step that is no white noise: it stays for as long as the signal does.
void requantise(Signal& signal, double noise_rms, double step, Noise& noise) {
  if (!(step > 0)) return disturb(signal, noise_rms, noise);
  constexpr std::size_t reach = 12;  // rows to each side: a step smoothed over
  const Signal said = signal;
  const double shift = noise.uniform();
  for (std::size_t k = 0; k < said.size(); ++k) {
    double sum = 0, count = 0;
    for (std::size_t n = k < reach ? 0 : k - reach; n < std::min(said.size(), k + reach + 1); ++n)
      if (!std::isnan(said[n])) sum += said[n], ++count;
    if (count == 0 || std::isnan(said[k])) continue;
    const double smooth = sum / count, noisy = smooth + noise_rms * noise.normal();
    signal[k] = said[k] + step * (std::round(noisy / step + shift) - shift) - smooth;
  }
}

/// Sampled half a period late, as by an amplifier that smooths.
void delay(Signal& signal) {
  constexpr double late = 0.5;
  const Signal said = signal;
  for (std::size_t k = 1; k + 1 < said.size(); ++k)
    signal[k] = said[k] - late * (said[k + 1] - said[k - 1]) / 2;
}

/// Rows taken later than stamped, all signals alike.
void disturb_times(Episode& e, Noise& noise) {
  Signal late_s(e.rows);
  for (double& t : late_s) t = e.jitter_s * noise.uniform();
  const auto disturb = [&](Signal& signal) {
    const Signal said = signal;
    for (std::size_t k = 0; k < signal.size(); ++k)
      signal[k] += rate_of(said, k, e.period_s) * late_s[k];
  };
  for (ActuatorSignals& s : e.actuators)
    disturb(s.voltage_V), disturb(s.current_A), disturb(s.shaft_rad), disturb(s.tension_N);
  for (JointSignals& j : e.joints) {
    disturb(j.angle_rad);
    for (Signal& part : j.quaternion) disturb(part);
  }
}

/// What no data sheet excludes: tensions half a period later, currents 0.3 % larger.
void doubt(Episode& e) {
  for (ActuatorSignals& s : e.actuators) {
    delay(s.tension_N);
    for (double& i : s.current_A) i *= 1 + calibration;
    if (s.current_A.empty())
      for (double& v : s.voltage_V) v *= 1 + of_voltage;
  }
}

/// What the sensors' noise and steps would have made of it.
void disturb(Episode& again, const erp::Robot& robot, std::uint64_t seed) {
  Noise noise(seed);
  if (again.jitter_s > 0) disturb_times(again, noise);
  const auto coarse = effects::read_effects(robot);
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const erp::SensorType& sensors = robot.sensors_of(robot.actuators[a]);
    const SensorScale scale(robot.motor_of(robot.actuators[a]), sensors);
    ActuatorSignals& s = again.actuators[a];
    const bool told = sensors.encoder_counts_per_rev > 0;  // some drives' are not
    if (told) requantise(s.shaft_rad, 0, scale.shaft_rad_per_count, noise);
    else disturb(s.shaft_rad, noise_of(s.shaft_rad), noise);
    requantise(s.current_A, sensors.current_noise_A, scale.current_A_per_count, noise);
    const bool drive = robot.actuators[a].tendon.path.empty();
    const double of_tension =
        drive && sensors.tension_noise_N == 0 ? noise_of(s.tension_N) : sensors.tension_noise_N;
    requantise(s.tension_N, of_tension, scale.tension_N_per_count, noise);
    const auto coarsen = [&](const char* type, Signal& signal) {
      if (const double step = coarse_step(coarse, type, robot.actuators[a].name); step > 0)
        requantise(signal, 0, step, noise);
    };
    coarsen("sensor_shaft_quantisation", s.shaft_rad);
    coarsen("sensor_current_quantisation", s.current_A);
    coarsen("sensor_tension_quantisation", s.tension_N);
  }
  const auto joints = robot.joints();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    JointSignals& signals = again.joints[j];
    const auto sensor =
        std::ranges::find(robot.joint_sensors, joints[j].name, &erp::JointSensor::joint);
    if (sensor != robot.joint_sensors.end() && joints[j].type == erp::JointType::revolute) {
      const double finest = 2 * std::numbers::pi / std::exp2(sensor->bits_per_rev);
      requantise(signals.angle_rad, sensor->noise_rad, finest, noise);
      if (const double step = coarse_step(coarse, "sensor_joint_quantisation", sensor->joint);
          step > 0)
        requantise(signals.angle_rad, 0, step, noise);
      continue;
    }
    disturb(signals.angle_rad, noise_of(signals.angle_rad), noise);
    for (Signal& part : signals.quaternion) disturb(part, noise_of(part), noise);
  }
}

/// What a change of the recording changes in one residual, at each window; NaN: not to be seen.
Signal changed(const Residual& said, const Residual& again) {
  Signal change;
  for (std::size_t k = 0; k < said.value.size(); ++k)
    change.push_back(banded(said, k) || banded(again, k) ? recording::not_taken
                                                         : again.value[k] - said.value[k]);
  return change;
}

}  // namespace

Episode resampled_noise(const Episode& episode, const erp::Robot& robot, std::uint64_t seed) {
  Episode again = episode;
  doubt(again);
  disturb(again, robot, seed);
  return again;
}

std::vector<Floor> floors(Stages& stages, const Episode& episode, const erp::Robot& robot,
                          std::uint64_t seed) {
  Episode noisy = episode, doubted = episode;
  disturb(noisy, robot, seed), doubt(doubted);
  const auto said = stages.residuals(episode), noise = stages.residuals(noisy),
             doubts = stages.residuals(doubted);
  std::vector<Floor> floors;
  for (std::size_t r = 0; r < said.size(); ++r) {
    const double of_noise = rms(changed(said[r], noise[r]));
    const Signal of_doubt = changed(said[r], doubts[r]);
    Floor floor{std::hypot(of_noise, rms(of_doubt)), {}};
    for (const double d : of_doubt)
      floor.at.push_back(std::isnan(d) ? floor.rms : std::max(floor.rms, std::hypot(of_noise, d)));
    floors.push_back(std::move(floor));
  }
  return floors;
}

}  // namespace sim::residuals
