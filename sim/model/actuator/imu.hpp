#pragma once
#include <cstdint>

#include "interfaces/robot/sensors.hpp"
#include "sim/model/actuator/noise.hpp"
#include "sim/model/skeleton/pose.hpp"

/// Reading of an inertial measurement unit (IMU) on a body, in the body's axes.
///
///   f = Rᵀ ((v − v₋)/(t − t₋) − g) + noise     mean specific force since the last sample
///   ω = Rᵀ ω_world + noise
///
/// v: velocity of the IMU; v₋: its value at the last sample.
///
/// Both are rounded to q = 2 range / 2^bits and saturate at ± range. At the first sample v = v₋, so
/// the reading is −g.
/// Ignores: bias and its drift, scale and axis errors, the unit's own bandwidth.
namespace sim {

struct ImuReading {
  Vec3 acceleration_m_per_s2 = Vec3::Zero(), turning_rad_per_s = Vec3::Zero();
};

class ImuSensor {
 public:
  ImuSensor(const erp::Imu& imu, const Vec3& gravity_m_per_s2, std::uint64_t seed);
  /// `time_s` must be later than the last sample.
  ImuReading sample(double time_s, const BodyPose& pose, const BodyTwist& twist);

 private:
  /// The value with noise, rounded and saturated.
  Vec3 converted(const Vec3& value, double noise, double range);
  erp::Imu imu_;
  Vec3 gravity_, velocity_m_per_s_ = Vec3::Zero();
  double time_s_ = 0;
  bool sampled_ = false;
  Noise noise_;
};

}  // namespace sim
