#include "sim/world/arm_poses.hpp"

#include <Eigen/Geometry>

namespace sim {

namespace {

/// Flexion (forwards), abduction (outwards), inward rotation of the shoulder; flexion of the elbow.
struct Angles {
  double flexion, abduction, rotation, elbow;  ///< rad
};

constexpr Angles poses[]{{0.0, 0.0, 0.0, 0.6},    {0.3, 0.0, 0.0, 0.9},   {0.5, 0.1, 0.0, 1.3},
                         {0.6, 0.2, 0.1, 1.7},    {0.4, 0.3, 0.2, 2.0},   {0.2, 0.45, 0.2, 1.6},
                         {0.0, 0.6, 0.1, 1.2},    {-0.2, 0.45, 0.0, 0.8}, {-0.3, 0.2, -0.1, 0.5},
                         {-0.1, 0.15, -0.3, 0.9}, {0.2, 0.3, -0.3, 1.2},  {0.45, 0.5, -0.1, 1.4},
                         {0.6, 0.5, 0.2, 1.0},    {0.3, 0.2, 0.3, 0.6},   {0.05, 0.05, 0.05, 0.2}};

/// The three as one rotation vector; the right arm goes outwards along -y.
std::array<double, 4> shoulder(const Angles& a) {
  const Eigen::Vector3d v(-a.abduction, -a.flexion, a.rotation);
  const double angle = v.norm();
  if (angle == 0) return {1, 0, 0, 0};
  const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, v / angle));
  return {q.w(), q.x(), q.y(), q.z()};
}

}  // namespace

std::vector<Pose> arm_poses() {
  std::vector<Pose> all;
  for (const Angles& a : poses) all.push_back({shoulder(a), {a.elbow, 0, 0, 0}});
  return all;
}

}  // namespace sim
