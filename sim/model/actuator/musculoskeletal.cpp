#include "sim/model/actuator/musculoskeletal.hpp"

#include "sim/model/actuator/with_actuator_name.hpp"

namespace sim {
namespace {

Vec3 gravity_of(const erp::Robot& robot) {
  const xml::Vec3 g = robot.gravity_m_per_s2();
  return {g[0], g[1], g[2]};
}

}  // namespace

Musculoskeletal::Musculoskeletal(const erp::Robot& robot)
    : tree_(robot), skeleton_(tree_, gravity_of(robot)) {
  for (const erp::Actuator& actuator : robot.actuators)
    with_actuator_name(actuator, [&] {
      routings_.emplace_back(actuator.tendon, tree_.names).require_outside(skeleton_.poses());
      levers_.push_back(levers_of(routings_.back(), skeleton_));
      shapes_.push_back(routings_.back().solve(skeleton_.poses()));
    });
  const auto actuators = static_cast<Eigen::Index>(robot.actuators.size());
  length_m_.setZero(actuators);
  jacobian_.setZero(actuators, coordinates());
  std::vector<JointReading> start_posture;
  for (const erp::Joint& joint : tree_.joints) start_posture.push_back(initial_reading(joint));
  place(start_posture);
}

void Musculoskeletal::place(std::span<const JointReading> joints) {
  skeleton_.place(joints);
  for (std::size_t a = 0; a < shapes_.size(); ++a) {
    const auto i = static_cast<Eigen::Index>(a);
    routings_[a].solve(skeleton_.poses(), shapes_[a]);
    length_m_[i] = shapes_[a].length_m;
    length_gradient(shapes_[a], levers_[a], skeleton_, row_);
    jacobian_.row(i) = row_;
  }
}

}  // namespace sim
