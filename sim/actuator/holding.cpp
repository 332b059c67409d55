#include "sim/actuator/holding.hpp"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

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

struct PoseHolder::Inside {
  explicit Inside(const erp::Robot& r)
      : robot(r), tree(r), model(tree, gravity_of(r)), shapes(r.actuators.size()) {
    for (const erp::Actuator& actuator : robot.actuators) {
      routings.emplace_back(actuator.tendon, tree.names);
      levers.push_back(levers_of(routings.back(), model));
    }
    for (std::size_t k = 0; k < shapes.size(); ++k) shapes[k] = routings[k].solve(model.poses());
    start_m = statics(starting_pose(robot)).length_m;
  }
  static Vec3 gravity_of(const erp::Robot& r) {
    const xml::Vec3 g = r.gravity_m_per_s2();
    return {g[0], g[1], g[2]};
  }

  Statics statics(const Pose& pose) {
    std::vector<JointReading> joints;
    for (std::size_t j = 0; j < pose.size(); ++j) {
      joints.push_back(start_of(tree.joints[j]));
      joints[j].position = pose[j];
    }
    model.place(joints);
    const auto actuators = static_cast<Eigen::Index>(shapes.size());
    Statics s{VectorXd(actuators), MatrixXd(actuators, model.coordinates()), {}};
    VectorXd row;
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      routings[k].solve(model.poses(), shapes[k]);
      if (const int element = shapes[k].pierced(); element >= 0)
        throw std::invalid_argument("actuator \"" + robot.actuators[k].name + "\": in this pose " +
                                    "a point beside element " + std::to_string(element + 1) +
                                    " of its path lies inside that pulley");
      length_gradient(shapes[k], levers[k], model, row);
      s.length_m[static_cast<Eigen::Index>(k)] = shapes[k].length_m;
      s.jacobian.row(static_cast<Eigen::Index>(k)) = row;
    }
    model.gravity_torques(s.gravity_Nm);
    return s;
  }

  erp::Robot robot;
  RobotTree tree;
  SkeletonModel model;
  std::vector<Routing> routings;
  std::vector<Levers> levers;
  std::vector<PathShape> shapes;  ///< in the last pose
  VectorXd start_m;
};

PoseHolder::PoseHolder(const erp::Robot& robot) : inside_(std::make_unique<Inside>(robot)) {}
PoseHolder::~PoseHolder() = default;

Holding PoseHolder::hold(const Pose& pose, const HoldingOptions& options) {
  const Statics now = inside_->statics(pose);
  const VectorXd f = balance(now.jacobian, -now.gravity_Nm, options);
  Holding holding;
  holding.unbalanced_Nm = (now.jacobian.transpose() * f + now.gravity_Nm).norm();
  for (std::size_t k = 0; k < inside_->shapes.size(); ++k) {
    const erp::Tendon& tendon = inside_->robot.actuators[k].tendon;
    const Spring spring = Spring::of(tendon);
    const auto i = static_cast<Eigen::Index>(k);
    holding.tension_N.push_back(f[i]);
    holding.line_m.push_back(now.length_m[i] - inside_->start_m[i] -
                             (spring.stretch_m(f[i]) - spring.stretch_m(tendon.pretension_N)));
  }
  return holding;
}

Holding hold_pose(const erp::Robot& robot, const Pose& pose, const HoldingOptions& options) {
  return PoseHolder(robot).hold(pose, options);
}

}  // namespace sim
