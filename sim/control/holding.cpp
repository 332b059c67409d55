#include "sim/control/holding.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <stdexcept>

#include "sim/model/actuator/musculoskeletal.hpp"
#include "sim/model/actuator/spring.hpp"

namespace sim {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The dual of eq. (1): D(λ) = bᵀ λ − Σ φ(J λ) − ε/2 |λ|², φ' = f. Concave, piecewise quadratic.
class Dual {
 public:
  Dual(const MatrixXd& j, const VectorXd& b, const HoldingOptions& options)
      : j_(j), b_(b), rest_(options.rest_N), least_(options.least_N) {
    constexpr double relative_epsilon =
        1e-8;  // of the largest Σ J²; chosen: the residual is far below friction
    epsilon_ = relative_epsilon * (j.size() > 0 ? j.colwise().squaredNorm().maxCoeff() : 1);
  }

  VectorXd tensions(const VectorXd& at) const {
    return (rest_ + (j_ * at).array()).max(least_).matrix();
  }
  VectorXd gradient(const VectorXd& at) const {
    return b_ - j_.transpose() * tensions(at) - epsilon_ * at;
  }
  double value(const VectorXd& at) const {
    const auto pull = rest_ + (j_ * at).array();
    const auto f = pull.max(least_);
    return b_.dot(at) - (f * pull - f.square() / 2).sum() - epsilon_ / 2 * at.squaredNorm();
  }
  VectorXd newton(const VectorXd& at, const VectorXd& gradient) const {
    const VectorXd pulling = ((rest_ + (j_ * at).array()) > least_).cast<double>();
    MatrixXd slope = j_.transpose() * pulling.asDiagonal() * j_;
    slope.diagonal().array() += epsilon_;
    return slope.ldlt().solve(gradient);
  }

 private:
  const MatrixXd& j_;
  const VectorXd& b_;
  double rest_, least_, epsilon_;
};

/// The tensions nearest to f_rest that hold b. If no tensions hold b, they minimise the residual.
VectorXd holding_tensions(const MatrixXd& j, const VectorXd& b, const HoldingOptions& options) {
  constexpr int max_steps = 200;                // chosen
  constexpr double tolerance_Nm = 1e-10;        // chosen
  constexpr double min_step_size = 1e-6;        // chosen
  constexpr double sufficient_increase = 1e-4;  // Armijo's constant, usual value
  const Dual dual(j, b, options);
  VectorXd lambda = VectorXd::Zero(j.cols());
  for (int k = 0; k < max_steps; ++k) {
    const VectorXd gradient = dual.gradient(lambda);
    if (gradient.norm() < tolerance_Nm) break;
    const VectorXd newton = dual.newton(lambda, gradient);
    const double start_value = dual.value(lambda), slope = gradient.dot(newton);
    double step_size = 1;
    while (step_size > min_step_size && dual.value(lambda + step_size * newton) <
                                            start_value + sufficient_increase * step_size * slope)
      step_size /= 2;
    lambda += step_size * newton;
  }
  return dual.tensions(lambda);
}

}  // namespace

struct PoseHolder::Implementation {
  explicit Implementation(const erp::Robot& r) : robot(r), model(r), start_m(model.length_m()) {}

  /// Throws if a path point lies inside a pulley.
  void place(const Pose& pose) {
    std::vector<JointReading> joints;
    for (std::size_t j = 0; j < pose.size(); ++j) {
      joints.push_back(initial_reading(model.tree().joints[j]));
      joints[j].position = pose[j];
    }
    model.place(joints);
    for (std::size_t k = 0; k < model.shapes().size(); ++k)
      if (const int element = model.shapes()[k].penetrated_pulley(); element >= 0)
        throw std::invalid_argument("actuator \"" + robot.actuators[k].name + "\": in this pose " +
                                    "a point beside element " + std::to_string(element + 1) +
                                    " of its path lies inside that pulley");
  }

  erp::Robot robot;
  Musculoskeletal model;
  VectorXd start_m;
};

PoseHolder::PoseHolder(const erp::Robot& robot)
    : implementation_(std::make_unique<Implementation>(robot)) {}
PoseHolder::~PoseHolder() = default;

Holding PoseHolder::hold(const Pose& pose, const HoldingOptions& options) {
  implementation_->place(pose);
  const MatrixXd& jacobian = implementation_->model.jacobian();
  VectorXd gravity_Nm;
  implementation_->model.skeleton().gravity_torques(gravity_Nm);
  const VectorXd f = holding_tensions(jacobian, -gravity_Nm, options);
  Holding holding;
  holding.unbalanced_Nm = (jacobian.transpose() * f + gravity_Nm).norm();
  for (Eigen::Index i = 0; i < f.size(); ++i) {
    const erp::Tendon& tendon =
        implementation_->robot.actuators[static_cast<std::size_t>(i)].tendon;
    const Spring spring = Spring::of(tendon);
    holding.tension_N.push_back(f[i]);
    holding.line_m.push_back(implementation_->model.length_m()[i] - implementation_->start_m[i] -
                             (spring.stretch_m(f[i]) - spring.stretch_m(tendon.pretension_N)));
  }
  return holding;
}

Holding hold_pose(const erp::Robot& robot, const Pose& pose, const HoldingOptions& options) {
  return PoseHolder(robot).hold(pose, options);
}

}  // namespace sim
