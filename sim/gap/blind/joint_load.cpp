#include "sim/gap/blind/joint_load.hpp"

#include <cmath>

#include "sim/model/actuator/muscle_jacobian.hpp"

namespace sim::blind {

double joint_load_Nm(const erp::Robot& robot, std::size_t joint) {
  const RobotTree tree(robot);
  SkeletonModel model(tree, {0, 0, 0});
  std::vector<JointReading> initial_pose;
  for (const erp::Joint& j : tree.joints) initial_pose.push_back(initial_reading(j));
  model.place(initial_pose);
  const int axis = model.first_of(static_cast<int>(joint));
  double sum_Nm = 0;
  Eigen::VectorXd moment_arms_m;
  for (const erp::Actuator& actuator : robot.actuators) {
    const Routing routing(actuator.tendon, tree.names);
    length_gradient(routing.solve(model.poses()), levers_of(routing, model), model, moment_arms_m);
    sum_Nm += actuator.max_tension_N * std::abs(moment_arms_m[axis]) / 2;
  }
  return sum_Nm;
}

}  // namespace sim::blind
