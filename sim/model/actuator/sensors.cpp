#include "sim/model/actuator/sensors.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sim {

namespace {
/// The nearest count, saturated at the limits.
double quantized(double value, double per_count, double low, double high) {
  return std::clamp(std::round(value / per_count), low, high);
}
}  // namespace

SensorScale::SensorScale(const erp::MotorType& motor, const erp::SensorType& sensors)
    : shaft_rad_per_count(2 * std::numbers::pi /
                          (sensors.encoder_counts_per_rev * motor.gear_ratio)),
      current_A_per_count(sensors.current_range_A / (1 << (sensors.current_bits - 1))),
      tension_N_per_count(sensors.tension_range_N /
                          ((1 << sensors.tension_bits) - 1 - sensors.tension_zero_counts)),
      current_counts_max((1 << (sensors.current_bits - 1)) - 1),
      tension_counts_max((1 << sensors.tension_bits) - 1),
      tension_zero_counts(sensors.tension_zero_counts) {}

ActuatorSensors::ActuatorSensors(const erp::MotorType& motor, const erp::SensorType& sensors,
                                 std::uint64_t seed, effects::Acting effects)
    : scale_(motor, sensors),
      gear_ratio_(motor.gear_ratio),
      current_noise_A_(sensors.current_noise_A),
      tension_noise_N_(sensors.tension_noise_N),
      noise_(seed),
      effects_(std::move(effects)) {}

ActuatorCounts ActuatorSensors::read(double shaft_rad, double current_A, double tension_N,
                                     double time_s) {
  double shaft = shaft_rad;
  double current = current_A + current_noise_A_ * noise_.normal();
  double tension = tension_N + tension_noise_N_ * noise_.normal();
  if (!effects_.empty()) {
    const effects::SensorSample sample{time_s, time_s - last_read_s_, gear_ratio_};
    shaft = effects_.read(effects::Sense::shaft, shaft, sample);
    current = effects_.read(effects::Sense::current, current, sample);
    tension = effects_.read(effects::Sense::tension, tension, sample);
    last_read_s_ = time_s;
  }
  return {static_cast<std::int32_t>(std::floor(shaft / scale_.shaft_rad_per_count + 0.5)),
          static_cast<std::int16_t>(quantized(current, scale_.current_A_per_count,
                                              -scale_.current_counts_max - 1,
                                              scale_.current_counts_max)),
          static_cast<std::uint16_t>(
              scale_.tension_zero_counts +
              quantized(tension, scale_.tension_N_per_count, -scale_.tension_zero_counts,
                        scale_.tension_counts_max - scale_.tension_zero_counts))};
}

double angle_rad(const JointReading& joint, std::optional<erp::AxisName> about) {
  const auto& p = joint.position;
  if (!about) return p[0];
  const Eigen::AngleAxisd turn(Eigen::Quaterniond(p[0], p[1], p[2], p[3]).normalized());
  const double angle = std::remainder(turn.angle(), 2 * std::numbers::pi);
  return angle * turn.axis()[static_cast<int>(*about)];
}

JointAngleSensor::JointAngleSensor(const erp::JointSensor& sensor, std::uint64_t seed,
                                   effects::Acting effects)
    : rad_per_count_(2 * std::numbers::pi / (1 << sensor.bits_per_rev)),
      noise_rad_(sensor.noise_rad),
      min_rad_(sensor.min_rad.value_or(-std::numeric_limits<double>::infinity())),
      max_rad_(sensor.max_rad.value_or(std::numeric_limits<double>::infinity())),
      about_(sensor.about),
      noise_(seed),
      effects_(std::move(effects)) {}

std::int32_t JointAngleSensor::read(const JointReading& joint, double time_s) {
  double measured_rad =
      effects_.sensor_shaft_rad(angle_rad(joint, about_)) + noise_rad_ * noise_.normal();
  if (!effects_.empty()) {
    measured_rad =
        effects_.read(effects::Sense::joint, measured_rad, {time_s, time_s - last_read_s_, 1});
    last_read_s_ = time_s;
  }
  return static_cast<std::int32_t>(
      std::round(std::clamp(measured_rad, min_rad_, max_rad_) / rad_per_count_));
}

PotentiometerSensor::PotentiometerSensor(const erp::Potentiometer& sensor, std::uint64_t seed)
    : sensor_(sensor), rad_per_count_(sensor.range_rad / ((1 << sensor.bits) - 1)), noise_(seed) {}

std::int32_t PotentiometerSensor::read(double shaft_rad) {
  const double measured_rad = sensor_.start_rad - shaft_rad + sensor_.noise_rad * noise_.normal();
  return static_cast<std::int32_t>(
      quantized(measured_rad, rad_per_count_, 0, (1 << sensor_.bits) - 1));
}

}  // namespace sim
