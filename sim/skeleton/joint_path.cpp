#include "sim/skeleton/joint_path.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace sim {
namespace {

using Eigen::Quaterniond;
using erp::JointType;

Quaterniond turn_of(const std::array<double, 4>& q) {
  return Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}

}  // namespace

Pose starting_pose(const erp::Robot& robot) {
  Pose pose;
  for (const erp::Joint& joint : robot.joints()) pose.push_back(start_of(joint).position);
  return pose;
}

std::array<double, 3> way_between(JointType type, const std::array<double, 4>& from,
                                  const std::array<double, 4>& to) {
  if (type == JointType::revolute) return {to[0] - from[0]};
  if (type != JointType::spherical) return {};
  Quaterniond turn = turn_of(from).conjugate() * turn_of(to);
  if (turn.w() < 0) turn.coeffs() *= -1;
  // u = 2 atan2(|v|, w) v / |v|
  const double sine = turn.vec().norm();
  const double scale = sine < 1e-12 ? 2 : 2 * std::atan2(sine, turn.w()) / sine;
  return {scale * turn.x(), scale * turn.y(), scale * turn.z()};
}

std::array<double, 4> gone(JointType type, const std::array<double, 4>& from,
                           const std::array<double, 3>& way) {
  if (type == JointType::revolute) return {from[0] + way[0]};
  if (type != JointType::spherical) return from;
  const Eigen::Vector3d u(way[0], way[1], way[2]);
  const double angle = u.norm(), scale = angle < 1e-12 ? 0.5 : std::sin(angle / 2) / angle;
  const Eigen::Vector3d v = scale * u;
  const Quaterniond q = turn_of(from) * Quaterniond(std::cos(angle / 2), v.x(), v.y(), v.z());
  return {q.w(), q.x(), q.y(), q.z()};
}

JointPath::JointPath(std::span<const erp::Joint> joints, std::vector<TimedPose> poses)
    : poses_(std::move(poses)) {
  if (poses_.empty()) throw std::invalid_argument("a way needs a pose at least");
  for (const erp::Joint& joint : joints) types_.push_back(joint.type);
  for (std::size_t k = 0; k + 1 < poses_.size(); ++k) {
    const TimedPose &from = poses_[k], &to = poses_[k + 1];
    if (!(to.time_s > from.time_s))
      throw std::invalid_argument("row " + std::to_string(k + 2) + ": time_s " +
                                  std::to_string(to.time_s) + " does not rise");
    auto& ways = ways_.emplace_back();
    for (std::size_t j = 0; j < types_.size(); ++j)
      ways.push_back(way_between(types_[j], from.pose[j], to.pose[j]));
  }
}

void JointPath::at(double time_s, std::vector<JointMotion>& motions) const {
  motions.resize(types_.size());
  const auto after = std::ranges::upper_bound(poses_, time_s, {}, &TimedPose::time_s);
  const auto k = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - poses_.begin() - 1, 0));
  const bool moves = k < ways_.size();
  const double T = moves ? poses_[k + 1].time_s - poses_[k].time_s : 1;
  const LeastJerk p = least_jerk(moves ? (time_s - poses_[k].time_s) / T : 0);
  for (std::size_t j = 0; j < types_.size(); ++j) {
    JointMotion& motion = motions[j];
    motion = {{types_[j], poses_[k].pose[j], {}, {}, {}}, {}};
    if (!moves) continue;
    std::array<double, 3> way = ways_[k][j];
    for (std::size_t d = 0; d < 3; ++d) {
      motion.now.velocity_rad_per_s[d] = p.speed / T * way[d];
      motion.acceleration_rad_per_s2[d] = p.acceleration / (T * T) * way[d];
      way[d] *= p.done;
    }
    motion.now.position = gone(types_[j], poses_[k].pose[j], way);
  }
}

}  // namespace sim
