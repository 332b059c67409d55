#pragma once
#include <cstdint>
#include <optional>

#include "interfaces/robot/robot.hpp"
#include "sim/model/actuator/noise.hpp"
#include "sim/model/effects/acting.hpp"
#include "sim/model/skeleton/joint_reading.hpp"

/// Readings of an ECU's converters (paper, 2.3 and 4.3), in counts.
///
///   encoder  = ⌊θ N c / 2π + ½⌋            c counts per motor revolution, 0 at power-on
///   current  = ⌊(i + noise) / q⌉           q = range / 2^(bits−1), −2^(bits−1) … 2^(bits−1) − 1
///   tension  = z + ⌊(F + noise) / q⌉       q = range / (2^bits − 1 − z), 0 … 2^bits − 1, z the
///                                          live zero
///   joint    = ⌊(φ + noise) / q⌉           q = 2π / 2^bits, not wrapped
///   potentiometer = ⌊(S_P + noise) / q⌉    S_P = (L_K − L_K0)/r + S_P0 = S_P0 − θ (eq. 5, in rad),
///                                          q = range / (2^bits − 1), 0 … 2^bits − 1
///
/// Outside its range a converter saturates. Effects on a sensor act on value and noise before the
/// converter. Ignores: lost encoder steps, the potentiometer's dead angle.
namespace sim {

/// Scale factors from counts to SI units for one actuator.
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

/// Converters of one actuator. `effects`: the effects on this actuator; only those on sensors are
/// used.
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
  double last_read_s_ = 0;
};

/// A joint angle sensor. `effects`: the effects on this joint; only play and effects on its sensor
/// are used.
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
  double last_read_s_ = 0;
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

/// The angle that a joint sensor measures: the angle of a revolute joint, or the component `about`
/// of the rotation vector (length up to π) from the parent's to the child's axes.
double angle_rad(const JointReading& joint, std::optional<erp::AxisName> about);

}  // namespace sim
