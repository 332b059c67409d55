#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "sim/model/skeleton/joint_reading.hpp"
#include "sim/model/skeleton/via_points.hpp"

/// Ways of joints through poses in time, with the least jerk (Flash and Hogan 1985).
///
///   q(t) = q_k ⊕ u(s),   s = (t − t_k)/T,   u(0) = 0,   u(1) = q_{k+1} ⊖ q_k
///
/// Of a ball joint u is a rotation vector in the child's frame. From rest to rest u goes straight,
/// u = p(s) u(1) with p = s³ (10 − 15 s + 6 s²): about one axis, which stands still in parent and
/// child. Through a pose without a halt velocity and acceleration are continuous; which they are
/// follows from the least jerk of each entry of u, for ball joints nearly the least.
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

/// What happens in the poses between the first and the last.
enum class Via {
  rest,    ///< a halt in each
  through  ///< a halt only where two rows in sequence are the same pose
};

class JointPath {
 public:
  JointPath() = default;
  /// Throws std::invalid_argument where times do not rise, or without a pose.
  JointPath(std::span<const erp::Joint> joints, std::vector<TimedPose> poses, Via via = Via::rest);

  double begin_s() const { return poses_.front().time_s; }
  double end_s() const { return poses_.back().time_s; }
  /// Every joint at a time; at rest in the first or last pose outside. No heap once `motions` has
  /// its size.
  void at(double time_s, std::vector<JointMotion>& motions) const;

 private:
  void check_times() const;
  void plan(Via via);
  Eigen::MatrixXd turns() const;
  std::vector<bool> rests(Via via) const;

  std::vector<erp::JointType> types_;
  std::vector<TimedPose> poses_;
  std::vector<std::vector<QuinticWay>> ways_;  ///< from each pose to the next, by joint
};

/// Where a way takes a hinge out of its range, by more than 0.01 rad; a way without halts swings out
/// beside its poses.
struct OutOfRange {
  std::size_t joint;
  double time_s, at_rad;
};
std::optional<OutOfRange> leaves_range(const JointPath& path, std::span<const erp::Joint> joints);

}  // namespace sim
