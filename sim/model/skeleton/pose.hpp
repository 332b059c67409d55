#pragma once
#include <Eigen/Core>
#include <array>

/// Poses and velocities of bodies.
namespace sim {

using Vec3 = Eigen::Vector3d;

/// Conversion from and to the arrays of messages and files.
inline Vec3 vec(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }
inline std::array<double, 3> numbers(const Vec3& v) { return {v[0], v[1], v[2]}; }

/// Pose of a body's frame in the world.
struct BodyPose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vec3 position_m = Vec3::Zero();
};

/// Angular velocity of a body and velocity of its frame's origin, world axes.
struct BodyTwist {
  Vec3 angular_rad_per_s = Vec3::Zero(), linear_m_per_s = Vec3::Zero();
};

}  // namespace sim
