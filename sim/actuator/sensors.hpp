#pragma once
#include <cstdint>

#include "interfaces/robot/robot.hpp"
#include "sim/actuator/noise.hpp"

/// What an ECU's converters read (paper, 2.3 and 4.3), as counts.
///
///   encoder  = ⌊θ N c / 2π + ½⌋            c counts a motor revolution, 0 where it booted
///   current  = ⌊(i + noise) / q⌉           q = range / 2^(bits−1), −2^(bits−1) … 2^(bits−1) − 1
///   tension  = ⌊(F + noise) / q⌉           q = range / (2^bits − 1), 0 … 2^bits − 1
///   joint    = ⌊(φ + noise) / q⌉           q = 2π / 2^bits, not wrapped
///
/// Beyond its range a converter stays at its rail. The potentiometer (eq. 5) is merged into the
/// encoder, as in the paper's simulator. Ignores: gain and offset errors, lost encoder steps.
namespace sim {

/// Counts to SI for one actuator.
struct SensorScale {
  double shaft_rad_per_count, current_A_per_count, tension_N_per_count;
  int current_counts_max, tension_counts_max;

  SensorScale(const erp::MotorType& motor, const erp::SensorType& sensors);
};

struct ActuatorCounts {
  std::int32_t encoder = 0;
  std::int16_t current = 0;
  std::uint16_t tension = 0;
};

/// One actuator's converters.
class ActuatorSensors {
 public:
  ActuatorSensors(const erp::MotorType& motor, const erp::SensorType& sensors, std::uint64_t seed);
  ActuatorCounts read(double shaft_rad, double current_A, double tension_N);
  const SensorScale& scale() const { return scale_; }

 private:
  SensorScale scale_;
  double current_noise_A_, tension_noise_N_;
  Noise noise_;
};

/// A joint angle sensor.
class JointAngleSensor {
 public:
  JointAngleSensor(const erp::JointSensor& sensor, std::uint64_t seed);
  std::int32_t read(double angle_rad);
  double rad_per_count() const { return rad_per_count_; }

 private:
  double rad_per_count_, noise_rad_;
  Noise noise_;
};

}  // namespace sim
