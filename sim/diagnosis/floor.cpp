#include "sim/diagnosis/floor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/actuator/noise.hpp"
#include "sim/actuator/sensors.hpp"

namespace sim::diagnosis {
namespace {

void disturb(Signal& signal, double noise_rms, double step, Noise& noise) {
  for (double& x : signal) x += noise_rms * noise.normal() + step * (noise.uniform() - 0.5);
}

/// Sampled half a period late: by an amplifier, or by a simulator's step.
void delay(Signal& signal) {
  constexpr double late = 0.5;
  const Signal said = signal;
  for (std::size_t k = 1; k + 1 < said.size(); ++k)
    signal[k] = said[k] - late * (said[k + 1] - said[k - 1]) / 2;
}

}  // namespace

Episode said_again(const Episode& episode, const erp::Robot& robot, std::uint64_t seed) {
  Episode again = episode;
  Noise noise(seed);
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const erp::SensorType& sensors = robot.sensors_of(robot.actuators[a]);
    const SensorScale scale(robot.motor_of(robot.actuators[a]), sensors);
    ActuatorSignals& s = again.actuators[a];
    delay(s.tension_N);
    disturb(s.shaft_rad, 0, scale.shaft_rad_per_count, noise);
    disturb(s.current_A, sensors.current_noise_A, scale.current_A_per_count, noise);
    disturb(s.tension_N, sensors.tension_noise_N, scale.tension_N_per_count, noise);
  }
  const auto joints = robot.joints();
  for (const erp::JointSensor& sensor : robot.joint_sensors)
    for (std::size_t j = 0; j < joints.size(); ++j)
      if (joints[j].name == sensor.joint)
        disturb(again.joints[j].angle_rad, sensor.noise_rad,
                2 * std::numbers::pi / std::exp2(sensor.bits_per_rev), noise);
  return again;
}

std::vector<double> floors(Stages& stages, const Episode& episode, const erp::Robot& robot,
                           std::uint64_t seed) {
  const auto said = stages.residuals(episode);
  const auto again = stages.residuals(said_again(episode, robot, seed));
  std::vector<double> floors;
  for (std::size_t r = 0; r < said.size(); ++r) {
    double square = 0;
    std::size_t windows = 0;
    for (std::size_t k = 0; k < said[r].value.size(); ++k)
      if (const double change = again[r].value[k] - said[r].value[k]; !std::isnan(change))
        square += change * change, ++windows;
    floors.push_back(windows ? std::sqrt(square / static_cast<double>(windows)) : 0);
  }
  return floors;
}

}  // namespace sim::diagnosis
