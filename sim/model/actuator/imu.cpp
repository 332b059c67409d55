#include "sim/model/actuator/imu.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sim {

ImuSensor::ImuSensor(const erp::Imu& imu, const Vec3& gravity, std::uint64_t seed)
    : imu_(imu), gravity_(gravity), noise_(seed) {}

Vec3 ImuSensor::converted(const Vec3& value, double noise, double range) {
  const double quantum = 2 * range / std::exp2(imu_.bits);
  Vec3 reading;
  for (int i = 0; i < 3; ++i)
    reading[i] = std::clamp(quantum * std::round((value[i] + noise * noise_.normal()) / quantum),
                            -range, range);
  return reading;
}

ImuReading ImuSensor::sample(double time_s, const BodyPose& pose, const BodyTwist& twist) {
  const Vec3 arm = pose.rotation * Vec3(imu_.at_m[0], imu_.at_m[1], imu_.at_m[2]);
  const Vec3 velocity = twist.linear_m_per_s + twist.angular_rad_per_s.cross(arm);
  Vec3 acceleration = Vec3::Zero();
  if (sampled_ && time_s > time_s_)
    acceleration = (velocity - velocity_m_per_s_) / (time_s - time_s_);
  velocity_m_per_s_ = velocity, time_s_ = time_s, sampled_ = true;
  const auto to_body = pose.rotation.transpose();
  return {converted(to_body * (acceleration - gravity_), imu_.acceleration_noise_m_per_s2,
                    imu_.acceleration_range_m_per_s2),
          converted(to_body * twist.angular_rad_per_s, imu_.turning_noise_rad_per_s,
                    imu_.turning_range_rad_per_s)};
}

}  // namespace sim
