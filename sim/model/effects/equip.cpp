// Applies the effects that change a robot's constants.
#include <algorithm>
#include <stdexcept>

#include "interfaces/robot/mass.hpp"
#include "sim/model/effects/library.hpp"
#include "sim/model/effects/own.hpp"

namespace sim::effects {

erp::MotorType& own_motor(erp::Robot& robot, erp::Actuator& actuator) {
  const std::string suffix = "_of_" + actuator.name;
  const bool is_shared =
      std::ranges::count(robot.actuators, actuator.motor, &erp::Actuator::motor) > 1;
  if (is_shared || !actuator.motor.ends_with(suffix)) {
    erp::MotorType type = robot.motor_of(actuator);
    type.name = actuator.motor + suffix;
    while (std::ranges::count(robot.motor_types, type.name, &erp::MotorType::name) > 0)
      type.name += '_';
    actuator.motor = type.name;
    robot.motor_types.push_back(type);
  }
  for (erp::MotorType& type : robot.motor_types)
    if (type.name == actuator.motor) return type;
  throw std::logic_error("internal error: a motor type that was just added is missing");
}

void resolve(erp::Body& body) {
  const erp::Mass mass = erp::mass_of(body);
  const auto& i = mass.inertia_kg_m2;
  body.mass_kg = mass.mass_kg, body.com_m = mass.com_m;
  body.inertia_kg_m2 = {i[0], i[1], i[2]}, body.products_kg_m2 = {i[3], i[4], i[5]};
  body.density_kg_per_m3.reset();
  std::erase_if(body.parts,
                [](const erp::Part& part) { return std::holds_alternative<erp::Weight>(part); });
}

namespace {

/// Applies the seams that change constants. Returns false if the effect also acts in each step.
struct Change {
  erp::Robot& robot;
  const std::string& on;

  bool operator()(const auto& effect) {
    bool changed = false;
    for (erp::Actuator& actuator : robot.actuators)
      if (actuator.name == on) changed |= change(effect, actuator);
    for (erp::Skeleton& part : robot.skeletons) {
      if constexpr (requires { effect.change_joint(part.joints[0]); })
        for (erp::Joint& joint : part.joints)
          if (joint.name == on) effect.change_joint(joint), changed = true;
      if constexpr (requires { effect.change_body(part.bodies[0]); })
        for (erp::Body& body : part.bodies)
          if (body.name == on) effect.change_body(body), changed = true;
    }
    if constexpr (requires { effect.change_robot(robot, on); })
      effect.change_robot(robot, on), changed = true;
    if constexpr (requires { effect.acts_per_step; }) return false;
    return changed;
  }
  bool change(const auto& effect, erp::Actuator& actuator) {
    if constexpr (requires { effect.change_motor(robot.motor_types[0]); })
      return effect.change_motor(own_motor(robot, actuator)), true;
    if constexpr (requires { effect.change_actuator(actuator); })
      return effect.change_actuator(actuator), true;
    return false;
  }
};

void reject_on_rope(const erp::Robot& robot, const Placed& placed) {
  const Stage stage = about(placed.effect).stage;
  const bool is_line_effect =
      stage == Stage::spindle || stage == Stage::tendon || stage == Stage::routing;
  for (const erp::Actuator& actuator : robot.actuators)
    if (is_line_effect && actuator.name == placed.on && actuator.rope)
      throw std::invalid_argument("effect \"" + std::string(about(placed.effect).type) +
                                  "\" on \"" + placed.on +
                                  "\": its tendon is a rope, whose model replaces this "
                                  "effect; remove the <rope> or the <effect>");
}

}  // namespace

Equipped equip(const erp::Robot& nominal) {
  Equipped result{nominal, {}};
  erp::Robot& robot = result.robot;
  while (!robot.effects.empty()) {
    const auto placed = read_effects(robot);
    robot.effects.clear();  // a seam may have added effects
    for (const Placed& p : placed) {
      reject_on_rope(robot, p);
      if (about(p.effect).seat == Seat::body)
        for (erp::Skeleton& part : robot.skeletons)
          for (erp::Body& body : part.bodies)
            if (body.name == p.on) resolve(body);
      if (!std::visit(Change{robot, p.on}, p.effect)) result.acting.push_back(p);
    }
  }
  return result;
}

}  // namespace sim::effects
