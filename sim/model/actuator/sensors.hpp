#pragma once
#include <cstdint>
#include <optional>

#include "interfaces/robot/robot.hpp"
#include "sim/model/actuator/noise.hpp"
#include "sim/model/effects/acting.hpp"
#include "sim/model/skeleton/joint_reading.hpp"

/// What an ECU's converters read (paper, 2.3 and 4.3), as counts.
///
///   encoder  = ⌊θ N c / 2π + ½⌋            c counts a motor revolution, 0 where it booted
///   current  = ⌊(i + noise) / q⌉           q = range / 2^(bits−1), −2^(bits−1) … 2^(bits−1) − 1
///   tension  = z + ⌊(F + noise) / q⌉       q = range / (2^bits − 1 − z), 0 … 2^bits − 1, z the
///                                          live zero
///   joint    = ⌊(φ + noise) / q⌉           q = 2π / 2^bits, not wrapped
///   potentiometer = ⌊(S_P + noise) / q⌉    S_P = (L_K − L_K0)/r + S_P0 = S_P0 − θ (eq. 5, in rad),
///                                          q = range / (2^bits − 1), 0 … 2^bits − 1
///
/// Beyond its range a converter stays at its rail. Effects on a sensor act on value and noise,
/// before the converter. Ignores: lost encoder steps, the potentiometer's dead angle.
namespace sim {

/// Counts to SI for one actuator.
struct SensorScale {
  double shaft_rad_per_count, current_A_per_count, tension_N_per_count;
  int current_counts_max, tension_counts_max, tension_zero_counts;

  SensorScale(const erp::MotorType& motor, const erp::SensorType& sensors);
};

struct ActuatorCounts {
  std::int32_t encoder = 0;
  std::int16_t current = 0;
  std::uint16_t tension = 0;
};

/// One actuator's converters. `effects`: of that actuator; those on its sensors act.
class ActuatorSensors {
 public:
  ActuatorSensors(const erp::MotorType& motor, const erp::SensorType& sensors, std::uint64_t seed,
                  effects::Acting effects = {});
  ActuatorCounts read(double shaft_rad, double current_A, double tension_N, double time_s = 0);
  const SensorScale& scale() const { return scale_; }

 private:
  SensorScale scale_;
  double gear_ratio_, current_noise_A_, tension_noise_N_;
  Noise noise_;
  effects::Acting effects_;
  double read_s_ = 0;
};

/// A joint angle sensor. `effects`: of that joint; those on its bearing and sensor act.
class JointAngleSensor {
 public:
  JointAngleSensor(const erp::JointSensor& sensor, std::uint64_t seed,
                   effects::Acting effects = {});
  std::int32_t read(const JointReading& joint, double time_s = 0);

 private:
  double rad_per_count_, noise_rad_, min_rad_, max_rad_;
  std::optional<erp::AxisName> about_;
  Noise noise_;
  effects::Acting effects_;
  double read_s_ = 0;
};

/// An absolute potentiometer on the gearbox shaft.
class PotentiometerSensor {
 public:
  PotentiometerSensor(const erp::Potentiometer& sensor, std::uint64_t seed);
  std::int32_t read(double shaft_rad);

 private:
  erp::Potentiometer sensor_;
  double rad_per_count_;
  Noise noise_;
};

/// The angle of a joint that such a sensor looks at: a revolute one's, or of its turning from the
/// parent's axes, as a rotation vector of length up to π, one component.
double angle_rad(const JointReading& joint, std::optional<erp::AxisName> about);

}  // namespace sim
