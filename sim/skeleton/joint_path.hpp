#pragma once
#include <array>
#include <span>
#include <vector>

#include "sim/skeleton/joint_reading.hpp"

/// Ways of joints through poses in time.
///
///   q(t) = q₀ ⊕ p(s) u,   s = (t − t₀)/T,   p(s) = s³ (10 − 15 s + 6 s²),   u = q₁ ⊖ q₀
///
/// Between two poses straight, with the least jerk (Flash and Hogan 1985), at rest in both. A ball
/// joint turns about one axis, which stands still in parent and child: u is the rotation vector in
/// the child's frame, and p′u/T, p″u/T² are velocity and acceleration there.
namespace sim {

/// One position a joint, as JointReading has it.
using Pose = std::vector<std::array<double, 4>>;

struct TimedPose {
  double time_s = 0;
  Pose pose;
};

/// How much of a way is done at the share s of its time, and its derivatives by s.
struct LeastJerk {
  double done = 0, speed = 0, acceleration = 0;
};
constexpr LeastJerk least_jerk(double s) {
  if (s <= 0) return {};
  if (s >= 1) return {.done = 1};
  return {s * s * s * (10 + s * (6 * s - 15)), 30 * s * s * (1 - s) * (1 - s),
          60 * s * (1 - s) * (1 - 2 * s)};
}
/// The most of LeastJerk::speed, in the middle of the way.
inline constexpr double least_jerk_top_speed = 1.875;

/// The pose a robot starts in.
Pose starting_pose(const erp::Robot& robot);

/// u = q₁ ⊖ q₀ of one joint: revolute [0], rad; ball joints a rotation vector in the child's frame,
/// at most half a turn; nothing of others.
std::array<double, 3> way_between(erp::JointType type, const std::array<double, 4>& from,
                                  const std::array<double, 4>& to);
/// q ⊕ u.
std::array<double, 4> gone(erp::JointType type, const std::array<double, 4>& from,
                           const std::array<double, 3>& way);

/// Where a joint is, how it moves, and how that changes; as JointReading.
struct JointMotion {
  JointReading now;
  std::array<double, 3> acceleration_rad_per_s2{};
};

class JointPath {
 public:
  JointPath() = default;
  /// Throws std::invalid_argument where times do not rise, or without a pose.
  JointPath(std::span<const erp::Joint> joints, std::vector<TimedPose> poses);

  double begin_s() const { return poses_.front().time_s; }
  double end_s() const { return poses_.back().time_s; }
  /// Every joint at a time; at rest in the first or last pose outside. No heap once `motions` has
  /// its size.
  void at(double time_s, std::vector<JointMotion>& motions) const;

 private:
  std::vector<erp::JointType> types_;
  std::vector<TimedPose> poses_;
  std::vector<std::vector<std::array<double, 3>>> ways_;  ///< from each pose to the next, by joint
};

}  // namespace sim
