#include "sim/gap/blind/joint_load.hpp"

#include <cmath>

#include "sim/model/actuator/muscle_jacobian.hpp"

namespace sim::blind {

double joint_load_Nm(const erp::Robot& robot, std::size_t joint) {
  const RobotTree tree(robot);
  SkeletonModel model(tree, {0, 0, 0});
  std::vector<JointReading> start;
  for (const erp::Joint& j : tree.joints) start.push_back(initial_reading(j));
  model.place(start);
  const int axis = model.first_of(static_cast<int>(joint));
  double sum_Nm = 0;
  Eigen::VectorXd row;
  for (const erp::Actuator& actuator : robot.actuators) {
    const Routing routing(actuator.tendon, tree.names);
    length_gradient(routing.solve(model.poses()), levers_of(routing, model), model, row);
    sum_Nm += actuator.max_tension_N * std::abs(row[axis]) / 2;
  }
  return sum_Nm;
}

}  // namespace sim::blind
