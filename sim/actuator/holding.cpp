#include "sim/actuator/holding.hpp"

#include <stdexcept>

#include "sim/actuator/musculoskeletal.hpp"
#include "sim/actuator/spring.hpp"
#include "sim/actuator/tension_share.hpp"

namespace sim {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// No tendon has a most here: what is asked of a robot is not what it may be asked.
TensionShare share_of(Eigen::Index actuators, int coordinates, const HoldingOptions& options) {
  constexpr double no_most_N = 1e9;
  return {
      {VectorXd::Ones(actuators), VectorXd::Constant(actuators, options.rest_N),
       VectorXd::Constant(actuators, options.least_N), VectorXd::Constant(actuators, no_most_N)},
      coordinates};
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
  TensionShare share = share_of(jacobian.rows(), inside_->model.coordinates(), options);
  const VectorXd f = share.share(jacobian, gravity_Nm);
  Holding holding;
  holding.unbalanced_Nm = share.missing().norm();
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
