#include "components/motion_capture/joint_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

#include "sim/model/skeleton/joint_path.hpp"

namespace capture {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using sim::BodyPose;
using sim::JointReading;
using sim::Vec3;

JointFit::JointFit(const sim::RobotTree& tree, std::vector<Marker> markers, const Options& options)
    : tree_(tree),
      markers_(std::move(markers)),
      options_(options),
      model_(tree, Vec3::Zero()),
      variance_(VectorXd::Constant(model_.coordinates(), options.before_rad * options.before_rad)) {
}

std::span<const BodyPose> JointFit::poses(std::span<const JointReading> joints) {
  model_.place(joints);
  return model_.poses();
}

double JointFit::fit(const MarkerPoints& seen, std::vector<JointReading>& joints) {
  constexpr int steps = 8;
  constexpr double settled_m = 1e-8;
  double residual_m = step(seen, joints);
  for (int k = 1; k < steps; ++k) {
    const double now_m = step(seen, joints);
    const bool settled = std::abs(residual_m - now_m) < settled_m;
    residual_m = now_m;
    if (settled) break;
  }
  return residual_m;
}

double JointFit::step(const MarkerPoints& seen, std::vector<JointReading>& joints) {
  model_.place(joints);
  const int n = model_.coordinates();
  const double weight = 1 / (options_.noise_m * options_.noise_m);
  MatrixXd normal = MatrixXd::Identity(n, n) / (options_.before_rad * options_.before_rad);
  VectorXd right = VectorXd::Zero(n);
  double squares = 0;
  int count = 0;
  for (std::size_t k = 0; k < markers_.size(); ++k) {
    if (!seen[k]) continue;
    const BodyPose& body = model_.poses()[markers_[k].body];
    const Vec3 at = body.position_m + body.rotation * markers_[k].at_m, off = *seen[k] - at;
    const auto movers = model_.movers(static_cast<int>(markers_[k].body));
    Eigen::Matrix3Xd slopes(3, movers.size());
    for (std::size_t d = 0; d < movers.size(); ++d) {
      const sim::Vec6 axis = model_.axis(movers[d]);
      slopes.col(static_cast<Eigen::Index>(d)) = axis.head<3>().cross(at) + axis.tail<3>();
    }
    for (std::size_t d = 0; d < movers.size(); ++d) {
      right[movers[d]] += weight * slopes.col(static_cast<Eigen::Index>(d)).dot(off);
      for (std::size_t e = 0; e < movers.size(); ++e)
        normal(movers[d], movers[e]) +=
            weight *
            slopes.col(static_cast<Eigen::Index>(d)).dot(slopes.col(static_cast<Eigen::Index>(e)));
    }
    squares += off.squaredNorm(), ++count;
  }
  const Eigen::LLT<MatrixXd> factor(normal);
  const VectorXd way = factor.solve(right);
  variance_ = factor.solve(MatrixXd::Identity(n, n)).diagonal();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const int first = model_.first_of(static_cast<int>(j));
    if (first < 0) continue;
    std::array<double, 3> turn{};
    for (int d = 0; d < std::min(sim::coordinates_of(joints[j].type), 3); ++d)
      turn[static_cast<std::size_t>(d)] = way[first + d];
    joints[j].position = sim::displaced(joints[j].type, joints[j].position, turn);
  }
  return count ? std::sqrt(squares / count) : 0;
}

void JointFit::from_bodies(const std::vector<std::optional<BodyPose>>& bodies,
                           std::vector<JointReading>& joints) const {
  for (std::size_t b = 0; b < tree_.bodies.size(); ++b) {
    const sim::TreeBody& body = tree_.bodies[b];
    if (body.joint < 0 || !bodies[b]) continue;
    const auto parent = static_cast<std::size_t>(body.parent);
    const bool rooted = tree_.bodies[parent].joint < 0;
    if (!bodies[parent] && !rooted) continue;
    const Eigen::Matrix3d base =
        bodies[parent] ? bodies[parent]->rotation : Eigen::Matrix3d::Identity();
    const Eigen::Quaterniond turn(base.transpose() * bodies[b]->rotation);
    const auto j = static_cast<std::size_t>(body.joint);
    const erp::Joint& joint = tree_.joints[j];
    if (joint.type == erp::JointType::spherical)
      joints[j].position = {turn.w(), turn.x(), turn.y(), turn.z()};
    if (joint.type == erp::JointType::revolute) {
      const Vec3 axis = Vec3(joint.axis[0], joint.axis[1], joint.axis[2]).normalized();
      joints[j].position[0] =
          std::remainder(2 * std::atan2(turn.vec().dot(axis), turn.w()), 2 * M_PI);
    }
  }
}

}  // namespace capture
