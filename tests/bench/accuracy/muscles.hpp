#pragma once
#include <vector>

#include "sim/model/actuator/muscle_jacobian.hpp"

namespace accuracy {

/// Sums over the forces of a path at a tension of 1 N, including the forces on pulleys. The moment
/// is about the origin of the world.
struct Sums {
  double power_W = 0;
  sim::Vec3 force_N = sim::Vec3::Zero(), moment_Nm = sim::Vec3::Zero();
};

/// A robot's skeleton and the paths of its tendons.
class Muscles {
 public:
  explicit Muscles(const erp::Robot& robot) : tree_(robot), model(tree_, sim::Vec3::Zero()) {
    for (const erp::Actuator& actuator : robot.actuators) add(actuator.tendon);
  }
  void add(const erp::Tendon& tendon) {
    routings_.emplace_back(tendon, tree_.names);
    levers_.push_back(sim::levers_of(routings_.back(), model));
  }
  std::size_t count() const { return routings_.size(); }
  sim::PathShape path(std::size_t k) const { return routings_[k].solve(model.poses()); }
  Eigen::VectorXd gradient(std::size_t k) const {
    Eigen::VectorXd row;
    sim::length_gradient(path(k), levers_[k], model, row);
    return row;
  }
  Sums sums(std::size_t k) const {
    const sim::PathShape shape = path(k);
    Sums total;
    for (const sim::PathPull& pull : shape.pulled()) {
      const auto body = static_cast<std::size_t>(pull.body);
      const sim::BodyTwist& twist = model.twists()[body];
      const sim::Vec3 lever_arm_m = pull.at_m - model.poses()[body].position_m;
      total.power_W +=
          pull.direction.dot(twist.linear_m_per_s + twist.angular_rad_per_s.cross(lever_arm_m));
      total.power_W += pull.moment_m.dot(twist.angular_rad_per_s);
      total.force_N += pull.direction;
      total.moment_Nm += pull.at_m.cross(pull.direction) + pull.moment_m;
    }
    return total;
  }

 private:
  sim::RobotTree tree_;
  std::vector<sim::Routing> routings_;
  std::vector<sim::Levers> levers_;

 public:
  sim::SkeletonModel model;
};

}  // namespace accuracy
