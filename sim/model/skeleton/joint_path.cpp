#include "sim/model/skeleton/joint_path.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sim/model/skeleton/rotation_vector.hpp"

namespace sim {
namespace {

using Eigen::Index;
using Eigen::Quaterniond;
using erp::JointType;

Quaterniond unit_quaternion(const std::array<double, 4>& q) {
  return Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}

/// Motion of a joint at an end of a segment.
struct End {
  Vec3 velocity, acceleration;
};

QuinticSegment segment_of(JointType type, const Vec3& u, const End& from, End to, double T) {
  if (type == JointType::spherical) {
    const RotationVector turn(u);
    to.velocity = turn.rate(to.velocity);
    to.acceleration = turn.rate_of_rate(to.velocity, to.acceleration);
  }
  return QuinticSegment::between(u, T * from.velocity, T * T * from.acceleration, T * to.velocity,
                                 T * T * to.acceleration);
}

}  // namespace

Pose starting_pose(const erp::Robot& robot) {
  Pose pose;
  for (const erp::Joint& joint : robot.joints()) pose.push_back(initial_reading(joint).position);
  return pose;
}

std::array<double, 3> displacement(JointType type, const std::array<double, 4>& from,
                                   const std::array<double, 4>& to) {
  if (type == JointType::revolute) return {to[0] - from[0]};
  if (type != JointType::spherical) return {};
  Quaterniond turn = unit_quaternion(from).conjugate() * unit_quaternion(to);
  if (turn.w() < 0) turn.coeffs() *= -1;
  // u = 2 atan2(|v|, w) v / |v|
  const double sine = turn.vec().norm();
  const double scale = sine < 1e-12 ? 2 : 2 * std::atan2(sine, turn.w()) / sine;
  return {scale * turn.x(), scale * turn.y(), scale * turn.z()};
}

std::array<double, 4> displaced(JointType type, const std::array<double, 4>& from,
                                const std::array<double, 3>& offset) {
  if (type == JointType::revolute) return {from[0] + offset[0]};
  if (type != JointType::spherical) return from;
  const Eigen::Vector3d u(offset[0], offset[1], offset[2]);
  const double angle = u.norm(), scale = angle < 1e-12 ? 0.5 : std::sin(angle / 2) / angle;
  const Eigen::Vector3d v = scale * u;
  const Quaterniond q =
      unit_quaternion(from) * Quaterniond(std::cos(angle / 2), v.x(), v.y(), v.z());
  return {q.w(), q.x(), q.y(), q.z()};
}

JointPath::JointPath(std::span<const erp::Joint> joints, std::vector<TimedPose> poses, Via via)
    : poses_(std::move(poses)) {
  if (poses_.empty()) throw std::invalid_argument("a joint trajectory needs at least one pose");
  for (const erp::Joint& joint : joints) types_.push_back(joint.type);
  check_times();
  if (poses_.size() > 1) plan(via);
}

void JointPath::check_times() const {
  for (std::size_t k = 1; k < poses_.size(); ++k)
    if (!(poses_[k].time_s > poses_[k - 1].time_s))
      throw std::invalid_argument("row " + std::to_string(k + 1) + ": time_s " +
                                  std::to_string(poses_[k].time_s) +
                                  " is not later than in the row before");
}

void JointPath::plan(Via via) {
  std::vector<double> times_s;
  for (const TimedPose& pose : poses_) times_s.push_back(pose.time_s);
  const Eigen::MatrixXd u = segment_displacements();
  const ViaMotions motions = minimum_jerk_through(times_s, u, rests(via));
  for (std::size_t k = 0; k + 1 < poses_.size(); ++k) {
    auto& segments = segments_.emplace_back();
    for (std::size_t j = 0; j < types_.size(); ++j) {
      const auto of = [&](const Eigen::MatrixXd& all, std::size_t row) -> Vec3 {
        return all.block<1, 3>(Index(row), Index(3 * j)).transpose();
      };
      const End from{of(motions.velocity, k), of(motions.acceleration, k)};
      const End to{of(motions.velocity, k + 1), of(motions.acceleration, k + 1)};
      segments.push_back(segment_of(types_[j], of(u, k), from, to, times_s[k + 1] - times_s[k]));
    }
  }
}

/// u(1) of all segments: segments × three columns per joint.
Eigen::MatrixXd JointPath::segment_displacements() const {
  Eigen::MatrixXd u(poses_.size() - 1, 3 * types_.size());
  for (std::size_t k = 0; k + 1 < poses_.size(); ++k)
    for (std::size_t j = 0; j < types_.size(); ++j)
      u.block<1, 3>(Index(k), Index(3 * j)) =
          vec(displacement(types_[j], poses_[k].pose[j], poses_[k + 1].pose[j])).transpose();
  return u;
}

std::vector<bool> JointPath::rests(Via via) const {
  std::vector<bool> rests(poses_.size(), via == Via::rest);
  for (std::size_t k = 0; k + 1 < poses_.size(); ++k)
    if (poses_[k].pose == poses_[k + 1].pose) rests[k] = rests[k + 1] = true;
  return rests;
}

void JointPath::at(double time_s, std::vector<JointMotion>& motions) const {
  motions.resize(types_.size());
  const auto after = std::ranges::upper_bound(poses_, time_s, {}, &TimedPose::time_s);
  const auto k = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - poses_.begin() - 1, 0));
  const bool moves = k < segments_.size() && time_s >= poses_[k].time_s;
  for (std::size_t j = 0; j < types_.size(); ++j) {
    JointMotion& motion = motions[j];
    motion = {{types_[j], poses_[k].pose[j], {}, {}, {}}, {}};
    if (!moves) continue;
    const double T = poses_[k + 1].time_s - poses_[k].time_s;
    auto p = segments_[k][j].at((time_s - poses_[k].time_s) / T);
    p.rate /= T, p.rate_of_rate /= T * T;
    const bool is_ball = types_[j] == JointType::spherical;
    const RotationVector turn(p.u);
    motion.now.velocity_rad_per_s = numbers(is_ball ? turn.speed(p.rate) : p.rate);
    motion.acceleration_rad_per_s2 =
        numbers(is_ball ? turn.acceleration(p.rate, p.rate_of_rate) : p.rate_of_rate);
    motion.now.position = displaced(types_[j], poses_[k].pose[j], numbers(p.u));
  }
}

std::optional<OutOfRange> leaves_range(const JointPath& path, std::span<const erp::Joint> joints) {
  constexpr double check_period_s = 0.01, tolerance_rad = 0.01;  // chosen
  std::vector<JointMotion> at;
  for (double t_s = path.begin_s(); t_s < path.end_s(); t_s += check_period_s) {
    path.at(t_s, at);
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const double q_rad = at[j].now.position[0];
      if (joints[j].type == JointType::revolute &&
          (q_rad < joints[j].min_rad - tolerance_rad || q_rad > joints[j].max_rad + tolerance_rad))
        return OutOfRange{j, t_s, q_rad};
    }
  }
  return std::nullopt;
}

}  // namespace sim
