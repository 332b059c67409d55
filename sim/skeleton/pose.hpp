#pragma once
#include <Eigen/Core>

/// Where bodies are and how they move.
namespace sim {

using Vec3 = Eigen::Vector3d;

/// Where a body's frame is, in the world.
struct BodyPose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vec3 position_m = Vec3::Zero();
};

/// How it moves: angular velocity and the velocity of its frame's origin, world axes.
struct BodyTwist {
  Vec3 angular_rad_per_s = Vec3::Zero(), linear_m_per_s = Vec3::Zero();
};

}  // namespace sim
