#include "sim/actuator/holding.hpp"

#include <Eigen/LU>
#include <cmath>

#include "sim/actuator/muscle_jacobian.hpp"
#include "sim/actuator/spring.hpp"
#include "sim/skeleton/skeleton_model.hpp"

namespace sim {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A robot in a pose: how long its tendons are, how that changes, and what gravity asks for.
struct Statics {
  VectorXd length_m;
  MatrixXd jacobian;  ///< ∂L/∂q, actuators × coordinates
  VectorXd gravity_Nm;
};

Statics statics_of(const erp::Robot& robot, const RobotTree& tree, SkeletonModel& model,
                   const Pose& pose) {
  std::vector<JointReading> joints;
  for (std::size_t j = 0; j < pose.size(); ++j) {
    joints.push_back(start_of(tree.joints[j]));
    joints[j].position = pose[j];
  }
  model.place(joints);
  const auto actuators = static_cast<Eigen::Index>(robot.actuators.size());
  Statics s{VectorXd(actuators), MatrixXd(actuators, model.coordinates()), {}};
  VectorXd row;
  for (Eigen::Index k = 0; k < actuators; ++k) {
    const Routing routing(robot.actuators[static_cast<std::size_t>(k)].tendon, tree.names);
    const PathShape shape = routing.solve(model.poses());
    length_gradient(shape, levers_of(routing, model), model, row);
    s.length_m[k] = shape.length_m;
    s.jacobian.row(k) = row;
  }
  model.gravity_torques(s.gravity_Nm);
  return s;
}

/// f = max(f_min, f_rest + J λ) with Jᵀ f = b.
VectorXd balance(const MatrixXd& j, const VectorXd& b, const HoldingOptions& options) {
  VectorXd lambda = VectorXd::Zero(j.cols());
  const auto tensions = [&](const VectorXd& at) {
    return VectorXd((j * at).array().max(options.least_N - options.rest_N) + options.rest_N);
  };
  for (int k = 0; k < 200; ++k) {
    const VectorXd f = tensions(lambda), missing = b - j.transpose() * f;
    if (missing.norm() < 1e-10) break;
    const VectorXd pulls = ((j * lambda).array() > options.least_N - options.rest_N).cast<double>();
    MatrixXd slope = j.transpose() * pulls.asDiagonal() * j;
    slope.diagonal().array() += 1e-9 + 1e-6 * slope.diagonal().maxCoeff();
    const VectorXd newton = slope.fullPivLu().solve(missing);
    double size = 1;
    while (size > 1e-6 &&
           (b - j.transpose() * tensions(lambda + size * newton)).norm() > missing.norm())
      size /= 2;
    lambda += size * newton;
  }
  return tensions(lambda);
}

}  // namespace

Pose starting_pose(const erp::Robot& robot) {
  Pose pose;
  for (const erp::Joint& joint : robot.joints()) pose.push_back(start_of(joint).position);
  return pose;
}

Holding hold_pose(const erp::Robot& robot, const Pose& pose, const HoldingOptions& options) {
  const RobotTree tree(robot);
  const xml::Vec3 g = robot.gravity_m_per_s2();
  SkeletonModel model(tree, {g[0], g[1], g[2]});
  const Statics start = statics_of(robot, tree, model, starting_pose(robot));
  const Statics now = statics_of(robot, tree, model, pose);
  const VectorXd f = balance(now.jacobian, -now.gravity_Nm, options);
  Holding holding;
  holding.unbalanced_Nm = (now.jacobian.transpose() * f + now.gravity_Nm).norm();
  for (std::size_t k = 0; k < robot.actuators.size(); ++k) {
    const erp::Tendon& tendon = robot.actuators[k].tendon;
    const Spring spring = Spring::of(tendon);
    const auto i = static_cast<Eigen::Index>(k);
    holding.tension_N.push_back(f[i]);
    holding.line_m.push_back(now.length_m[i] - start.length_m[i] -
                             (spring.stretch_m(f[i]) - spring.stretch_m(tendon.pretension_N)));
  }
  return holding;
}

}  // namespace sim
