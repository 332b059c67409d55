#include "sim/actuator/holding.hpp"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "sim/actuator/musculoskeletal.hpp"
#include "sim/actuator/spring.hpp"

namespace sim {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

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

struct PoseHolder::Inside {
  explicit Inside(const erp::Robot& r) : robot(r), model(r), start_m(model.length_m()) {}

  /// Throws where a point of a path lies inside its pulley.
  void place(const Pose& pose) {
    std::vector<JointReading> joints;
    for (std::size_t j = 0; j < pose.size(); ++j) {
      joints.push_back(start_of(model.tree().joints[j]));
      joints[j].position = pose[j];
    }
    model.place(joints);
    for (std::size_t k = 0; k < model.shapes().size(); ++k)
      if (const int element = model.shapes()[k].pierced(); element >= 0)
        throw std::invalid_argument("actuator \"" + robot.actuators[k].name + "\": in this pose " +
                                    "a point beside element " + std::to_string(element + 1) +
                                    " of its path lies inside that pulley");
  }

  erp::Robot robot;
  Musculoskeletal model;
  VectorXd start_m;
};

PoseHolder::PoseHolder(const erp::Robot& robot) : inside_(std::make_unique<Inside>(robot)) {}
PoseHolder::~PoseHolder() = default;

Holding PoseHolder::hold(const Pose& pose, const HoldingOptions& options) {
  inside_->place(pose);
  const MatrixXd& jacobian = inside_->model.jacobian();
  VectorXd gravity_Nm;
  inside_->model.skeleton().gravity_torques(gravity_Nm);
  const VectorXd f = balance(jacobian, -gravity_Nm, options);
  Holding holding;
  holding.unbalanced_Nm = (jacobian.transpose() * f + gravity_Nm).norm();
  for (Eigen::Index i = 0; i < f.size(); ++i) {
    const erp::Tendon& tendon = inside_->robot.actuators[static_cast<std::size_t>(i)].tendon;
    const Spring spring = Spring::of(tendon);
    holding.tension_N.push_back(f[i]);
    holding.line_m.push_back(inside_->model.length_m()[i] - inside_->start_m[i] -
                             (spring.stretch_m(f[i]) - spring.stretch_m(tendon.pretension_N)));
  }
  return holding;
}

Holding hold_pose(const erp::Robot& robot, const Pose& pose, const HoldingOptions& options) {
  return PoseHolder(robot).hold(pose, options);
}

}  // namespace sim
