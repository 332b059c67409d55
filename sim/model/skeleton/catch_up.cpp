#include "sim/model/skeleton/catch_up.hpp"

#include <Eigen/Geometry>

#include "sim/model/skeleton/rotation_vector.hpp"

namespace sim {
namespace {

using erp::JointType;

/// Eᵀ: rotates a vector from the frame of the trajectory to the frame of the joint, which deviates
/// by u.
Eigen::Matrix3d to_joint_frame(JointType type, const Vec3& u) {
  const double angle = u.norm();
  if (type != JointType::spherical || angle < 1e-12) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(-angle, u / angle).toRotationMatrix();
}

}  // namespace

CatchUp::CatchUp(std::span<const JointReading> now, std::span<const JointMotion> desired,
                 double duration_s)
    : duration_s_(duration_s) {
  for (std::size_t j = 0; j < now.size(); ++j) {
    const JointType type = now[j].type;
    starts_.push_back(displacement(type, desired[j].now.position, now[j].position));
    const Vec3 u = vec(starts_.back()), zero = Vec3::Zero();
    const Vec3 relative_velocity = vec(now[j].velocity_rad_per_s) -
                                   to_joint_frame(type, u) * vec(desired[j].now.velocity_rad_per_s);
    const Vec3 rate = type == JointType::spherical ? RotationVector(u).rate(relative_velocity)
                                                   : relative_velocity;
    segments_.push_back(QuinticSegment::between(-u, duration_s * rate, zero, zero, zero));
  }
}

void CatchUp::add(double time_s, std::span<JointMotion> desired) const {
  if (time_s >= duration_s_) return;
  for (std::size_t j = 0; j < segments_.size(); ++j) {
    auto& [now, acceleration] = desired[j];
    auto p = segments_[j].at(time_s / duration_s_);
    p.u += vec(starts_[j]), p.rate /= duration_s_, p.rate_of_rate /= duration_s_ * duration_s_;
    const bool is_ball = now.type == JointType::spherical;
    const RotationVector turn(p.u);
    const Vec3 deviation_velocity = is_ball ? turn.speed(p.rate) : p.rate;
    const Eigen::Matrix3d to_joint = to_joint_frame(now.type, p.u);
    const Vec3 trajectory_velocity = to_joint * vec(now.velocity_rad_per_s);
    const Vec3 deviation_acceleration =
        is_ball ? turn.acceleration(p.rate, p.rate_of_rate) : p.rate_of_rate;
    const Vec3 coriolis = is_ball ? deviation_velocity.cross(trajectory_velocity) : Vec3::Zero();
    acceleration = numbers(to_joint * vec(acceleration) - coriolis + deviation_acceleration);
    now.velocity_rad_per_s = numbers(trajectory_velocity + deviation_velocity);
    now.position = displaced(now.type, now.position, numbers(p.u));
  }
}

}  // namespace sim
