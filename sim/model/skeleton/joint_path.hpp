#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "sim/model/skeleton/joint_reading.hpp"
#include "sim/model/skeleton/via_points.hpp"

/// Minimum-jerk joint trajectories through poses at given times (Flash and Hogan 1985).
///
///   q(t) = q_k ⊕ u(s),   s = (t − t_k)/T,   u(0) = 0,   u(1) = q_{k+1} ⊖ q_k
///
/// For a ball joint u is a rotation vector in the child's frame. From rest to rest u follows a
/// straight line, u = p(s) u(1) with p = s³ (10 − 15 s + 6 s²): a rotation about an axis that is
/// fixed in parent and child. In a pose that is passed without a stop, velocity and acceleration
/// are continuous. Their values minimise the jerk of each entry of u; for ball joints the result is
/// nearly minimum jerk.
namespace sim {

/// One position per joint, in the format of JointReading.
using Pose = std::vector<std::array<double, 4>>;

struct TimedPose {
  double time_s = 0;
  Pose pose;
};

/// Completed fraction of a minimum-jerk motion at the time fraction s, and its derivatives by s.
struct MinimumJerk {
  double fraction = 0, speed = 0, acceleration = 0;
};
constexpr MinimumJerk minimum_jerk(double s) {
  if (s <= 0) return {};
  if (s >= 1) return {.fraction = 1};
  return {s * s * s * (10 + s * (6 * s - 15)), 30 * s * s * (1 - s) * (1 - s),
          60 * s * (1 - s) * (1 - 2 * s)};
}
/// Maximum of MinimumJerk::speed, at s = 0.5.
inline constexpr double minimum_jerk_top_speed = 1.875;

/// The starting pose of a robot.
Pose starting_pose(const erp::Robot& robot);

/// u = q₁ ⊖ q₀ of one joint: revolute [0], rad; for ball joints a rotation vector in the child's
/// frame, at most half a turn; zero for other types.
std::array<double, 3> displacement(erp::JointType type, const std::array<double, 4>& from,
                                   const std::array<double, 4>& to);
/// q ⊕ u, the inverse of `displacement`.
std::array<double, 4> displaced(erp::JointType type, const std::array<double, 4>& from,
                                const std::array<double, 3>& offset);

/// Position, velocity and acceleration of a joint, in the format of JointReading.
struct JointMotion {
  JointReading now;
  std::array<double, 3> acceleration_rad_per_s2{};
};

/// Behaviour in the poses between the first and the last.
enum class Via {
  rest,    ///< stop in each pose
  through  ///< stop only where two consecutive rows have the same pose
};

class JointPath {
 public:
  JointPath() = default;
  /// Throws std::invalid_argument if times do not increase or there is no pose.
  JointPath(std::span<const erp::Joint> joints, std::vector<TimedPose> poses, Via via = Via::rest);

  double begin_s() const { return poses_.front().time_s; }
  double end_s() const { return poses_.back().time_s; }
  /// Motion of every joint at a time; before the first and after the last pose, at rest there. No
  /// heap once `motions` has its size.
  void at(double time_s, std::vector<JointMotion>& motions) const;

 private:
  void check_times() const;
  void plan(Via via);
  Eigen::MatrixXd segment_displacements() const;
  std::vector<bool> rests(Via via) const;

  std::vector<erp::JointType> types_;
  std::vector<TimedPose> poses_;
  std::vector<std::vector<QuinticSegment>> segments_;  ///< from each pose to the next, by joint
};

/// A time at which a trajectory moves a hinge out of its range by more than 0.01 rad. A trajectory
/// without stops may overshoot its poses.
struct OutOfRange {
  std::size_t joint;
  double time_s, at_rad;
};
std::optional<OutOfRange> leaves_range(const JointPath& path, std::span<const erp::Joint> joints);

}  // namespace sim
