#pragma once
#include <cstdint>

#include "interfaces/robot/sensors.hpp"
#include "sim/model/actuator/noise.hpp"
#include "sim/model/skeleton/pose.hpp"

/// What an inertial unit on a body reads, in the body's axes.
///
///   f = Rᵀ ((v − v₋)/(t − t₋) − g) + noise     specific force; v of the unit's place, v₋ at its
///   ω = Rᵀ ω_world + noise                       last look: the mean over the time between
///
/// both rounded to q = 2 range / 2^bits and held at ± range. At its first look v = v₋: it reads −g.
/// Ignores: bias and its drift, scale and axis errors, the unit's own bandwidth.
namespace sim {

struct ImuReading {
  Vec3 acceleration_m_per_s2 = Vec3::Zero(), turning_rad_per_s = Vec3::Zero();
};

class ImuSensor {
 public:
  ImuSensor(const erp::Imu& imu, const Vec3& gravity_m_per_s2, std::uint64_t seed);
  /// At a time after the last look.
  ImuReading look(double time_s, const BodyPose& pose, const BodyTwist& twist);

 private:
  Vec3 disturbed(const Vec3& value, double noise, double range);
  erp::Imu imu_;
  Vec3 gravity_, velocity_m_per_s_ = Vec3::Zero();
  double time_s_ = 0;
  bool looked_ = false;
  Noise noise_;
};

}  // namespace sim
