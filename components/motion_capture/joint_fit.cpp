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
      variance_(VectorXd::Constant(model_.coordinates(),
                                   options.prior_sigma_rad * options.prior_sigma_rad)) {}

std::span<const BodyPose> JointFit::poses(std::span<const JointReading> joints) {
  model_.place(joints);
  return model_.poses();
}

double JointFit::fit(const MarkerPoints& measured, std::vector<JointReading>& joints) {
  constexpr int max_steps = 8;            // chosen
  constexpr double convergence_m = 1e-8;  // chosen
  double residual_m = step(measured, joints);
  for (int k = 1; k < max_steps; ++k) {
    const double new_residual_m = step(measured, joints);
    const bool converged = std::abs(residual_m - new_residual_m) < convergence_m;
    residual_m = new_residual_m;
    if (converged) break;
  }
  return residual_m;
}

double JointFit::step(const MarkerPoints& measured, std::vector<JointReading>& joints) {
  model_.place(joints);
  const int n = model_.coordinates();
  const double weight = 1 / (options_.noise_m * options_.noise_m);
  MatrixXd normal =
      MatrixXd::Identity(n, n) / (options_.prior_sigma_rad * options_.prior_sigma_rad);
  VectorXd gradient = VectorXd::Zero(n);
  double square_sum_m2 = 0;
  int count = 0;
  for (std::size_t k = 0; k < markers_.size(); ++k) {
    if (!measured[k]) continue;
    const BodyPose& body = model_.poses()[markers_[k].body];
    const Vec3 predicted_m = body.position_m + body.rotation * markers_[k].at_m,
               residual = *measured[k] - predicted_m;
    const auto coordinates = model_.movers(static_cast<int>(markers_[k].body));
    Eigen::Matrix3Xd jacobian(3, coordinates.size());
    for (std::size_t d = 0; d < coordinates.size(); ++d) {
      const sim::Vec6 axis = model_.axis(coordinates[d]);
      jacobian.col(static_cast<Eigen::Index>(d)) =
          axis.head<3>().cross(predicted_m) + axis.tail<3>();
    }
    for (std::size_t d = 0; d < coordinates.size(); ++d) {
      gradient[coordinates[d]] += weight * jacobian.col(static_cast<Eigen::Index>(d)).dot(residual);
      for (std::size_t e = 0; e < coordinates.size(); ++e)
        normal(coordinates[d], coordinates[e]) +=
            weight * jacobian.col(static_cast<Eigen::Index>(d))
                         .dot(jacobian.col(static_cast<Eigen::Index>(e)));
    }
    square_sum_m2 += residual.squaredNorm(), ++count;
  }
  const Eigen::LLT<MatrixXd> factor(normal);
  const VectorXd correction = factor.solve(gradient);
  variance_ = factor.solve(MatrixXd::Identity(n, n)).diagonal();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const int first = model_.first_of(static_cast<int>(j));
    if (first < 0) continue;
    std::array<double, 3> rotation_rad{};
    for (int d = 0; d < std::min(sim::coordinates_of(joints[j].type), 3); ++d)
      rotation_rad[static_cast<std::size_t>(d)] = correction[first + d];
    joints[j].position = sim::displaced(joints[j].type, joints[j].position, rotation_rad);
  }
  return count ? std::sqrt(square_sum_m2 / count) : 0;
}

void JointFit::from_bodies(const std::vector<std::optional<BodyPose>>& bodies,
                           std::vector<JointReading>& joints) const {
  for (std::size_t b = 0; b < tree_.bodies.size(); ++b) {
    const sim::TreeBody& body = tree_.bodies[b];
    if (body.joint < 0 || !bodies[b]) continue;
    const auto parent = static_cast<std::size_t>(body.parent);
    const bool parent_is_world = tree_.bodies[parent].joint < 0;
    if (!bodies[parent] && !parent_is_world) continue;
    const Eigen::Matrix3d base =
        bodies[parent] ? bodies[parent]->rotation : Eigen::Matrix3d::Identity();
    const Eigen::Quaterniond rotation(base.transpose() * bodies[b]->rotation);
    const auto j = static_cast<std::size_t>(body.joint);
    const erp::Joint& joint = tree_.joints[j];
    if (joint.type == erp::JointType::spherical)
      joints[j].position = {rotation.w(), rotation.x(), rotation.y(), rotation.z()};
    if (joint.type == erp::JointType::revolute) {
      const Vec3 axis = Vec3(joint.axis[0], joint.axis[1], joint.axis[2]).normalized();
      joints[j].position[0] =
          std::remainder(2 * std::atan2(rotation.vec().dot(axis), rotation.w()), 2 * M_PI);
    }
  }
}

}  // namespace capture
