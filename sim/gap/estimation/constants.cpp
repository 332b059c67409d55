#include "sim/gap/estimation/constants.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "interfaces/robot/mass.hpp"
#include "sim/gap/estimation/tolerances.hpp"
#include "sim/model/effects/library.hpp"
#include "sim/model/effects/own.hpp"

namespace sim::estimation {
namespace {

using effects::Stage;

/// A number of a motor or gearbox. Tolerances are chosen: catalogues state torque constant and
/// resistance to 5 … 10 %, and seldom state friction.
struct MotorNumber {
  const char* name;
  Stage stage;
  double erp::MotorType::*number;
  double relative;  ///< tolerance / number
  const char* effect;
  double far_sigma = default_far_sigma;
};
/// `far_sigma` of frictions and dampings. It is large because their nominal value may be near 0;
/// chosen.
constexpr double friction_far_sigma = 500;
constexpr MotorNumber motor_numbers[] = {
    {"resistance_ohm", Stage::motor, &erp::MotorType::resistance_ohm, 0.05, "motor_resistance"},
    {"torque_Nm_per_A", Stage::motor, &erp::MotorType::torque_Nm_per_A, 0.04,
     "motor_torque_constant"},
    {"inductance_H", Stage::motor, &erp::MotorType::inductance_H, 0.1, "motor_inductance"},
    {"gear_efficiency", Stage::gearbox, &erp::MotorType::gear_efficiency, 0.05,
     "gearbox_efficiency"},
    {"rotor_inertia_kg_m2", Stage::gearbox, &erp::MotorType::rotor_inertia_kg_m2, 0.05,
     "gearbox_inertia"},
    {"gear_coulomb_Nm", Stage::gearbox, &erp::MotorType::gear_coulomb_Nm, 0.2, "gearbox_coulomb",
     friction_far_sigma},
    {"gear_viscous_Nm_s_per_rad", Stage::gearbox, &erp::MotorType::gear_viscous_Nm_s_per_rad, 0.2,
     "gearbox_viscous", friction_far_sigma},
    {"rotor_coulomb_Nm", Stage::gearbox, &erp::MotorType::rotor_coulomb_Nm, 0.2, "gearbox_coulomb",
     friction_far_sigma},
    {"rotor_viscous_Nm_s_per_rad", Stage::gearbox, &erp::MotorType::rotor_viscous_Nm_s_per_rad, 0.2,
     "gearbox_viscous", friction_far_sigma},
};

// Relative tolerances, then tolerances of zeros; chosen.
constexpr double of_radius = 0.03, of_stiffness = 0.05, of_damping = 0.2, of_moment_arm = 0.03;
constexpr double of_tension_gain = 0.02, of_current_gain = 0.02;
constexpr double of_joint_friction = 0.2, of_mass = 0.04, of_com = 0.03, of_inertia = 0.06;
constexpr double smallest_factor = 0.05;  // lower bound of a constant / nominal; chosen
constexpr double line_zero_m = 3e-4, tension_zero_N = 0.1, current_zero_A = 0.01,
                 angle_zero_rad = 0.005;

erp::Actuator& actuator_of(erp::Robot& robot, const std::string& name) {
  return *std::ranges::find(robot.actuators, name, &erp::Actuator::name);
}
erp::Body& body_of(erp::Robot& robot, const std::string& name) {
  for (erp::Skeleton& part : robot.skeletons)
    for (erp::Body& body : part.bodies)
      if (body.name == name) return body;
  throw std::out_of_range(name);
}
erp::Joint& joint_of(erp::Robot& robot, const std::string& name) {
  for (erp::Skeleton& part : robot.skeletons)
    for (erp::Joint& joint : part.joints)
      if (joint.name == name) return joint;
  throw std::out_of_range(name);
}

/// Sets a number by an effect whose first parameter is value − nominal.
auto by_effect(const char* type, const std::string& on, double nominal) {
  return [type, on, nominal](erp::Robot& robot, double value) {
    effects::Placed placed{on, *effects::neutral(type)};
    *effects::parameters(placed.effect)[0].value = value - nominal;
    if (value != nominal) robot.effects.push_back(effects::written(placed));
  };
}

effects::Bounds bounds_of(const char* type) {
  effects::AnyEffect effect = *effects::neutral(type);
  return effects::parameters(effect)[0].bounds;
}

/// Ratio of an effect's first parameter to the change of a motor's number: relative, or for
/// friction at the gearbox shaft.
double motor_scale(const erp::MotorType& motor, double erp::MotorType::*number) {
  if (number == &erp::MotorType::gear_coulomb_Nm ||
      number == &erp::MotorType::gear_viscous_Nm_s_per_rad)
    return 1;
  if (number == &erp::MotorType::rotor_coulomb_Nm) return motor.gear_ratio;
  if (number == &erp::MotorType::rotor_viscous_Nm_s_per_rad)
    return motor.gear_ratio * motor.gear_ratio;
  return 1 / (motor.*number);
}

/// Sets a number of a motor. Torque and back-EMF constant are one number (K_T i ω = K_E ω i) and
/// are set together.
void set_number(erp::MotorType& motor, double erp::MotorType::*number, double value) {
  if (number == &erp::MotorType::torque_Nm_per_A)
    motor.back_emf_V_s_per_rad *= value / motor.torque_Nm_per_A;
  motor.*number = value;
}

void add_motor(std::vector<Constant>& all, const erp::Robot& robot, std::size_t a) {
  const erp::Actuator& actuator = robot.actuators[a];
  for (const auto& [name, stage, number, relative, effect, far_sigma] : motor_numbers) {
    const double nominal = robot.motor_of(actuator).*number;
    if (!(nominal > 0)) continue;
    all.push_back({name,
                   stage,
                   actuator.name,
                   nominal,
                   relative * nominal,
                   smallest_factor * nominal,
                   {.line = true, .chain = a},
                   [on = actuator.name, number](erp::Robot& r, double value) {
                     set_number(effects::own_motor(r, actuator_of(r, on)), number, value);
                   },
                   effect,
                   motor_scale(robot.motor_of(actuator), number),
                   false,
                   far_sigma});
  }
}

void add_line(std::vector<Constant>& all, const erp::Robot& robot, std::size_t a) {
  const erp::Actuator& actuator = robot.actuators[a];
  const residuals::Reach line{.line = true, .chain = a};
  const auto number = [&](const char* name, Stage stage, double nominal, double relative,
                          const char* effect, auto set) {
    const bool is_damping = std::string_view(name) == "damping_N_s_per_m";
    if (!(nominal > 0)) return;
    all.push_back(
        {name, stage, actuator.name, nominal, relative * nominal, smallest_factor * nominal, line,
         [on = actuator.name, set](erp::Robot& r, double value) { set(actuator_of(r, on), value); },
         effect, is_damping ? 1 : 1 / nominal, false,
         is_damping ? friction_far_sigma : default_far_sigma});
    all.back().in_series = std::string_view(name) == "stiffness_N_per_m";
  };
  number("radius_m", Stage::spindle, actuator.spindle.radius_m, of_radius, "spindle_radius",
         [](erp::Actuator& x, double v) { x.spindle.radius_m = v; });
  number("stiffness_N_per_m", Stage::tendon, actuator.tendon.stiffness_N_per_m, of_stiffness,
         "tendon_stiffness", [](erp::Actuator& x, double v) { x.tendon.stiffness_N_per_m = v; });
  number("damping_N_s_per_m", Stage::tendon, actuator.tendon.damping_N_s_per_m, of_damping,
         "tendon_damping", [](erp::Actuator& x, double v) { x.tendon.damping_N_s_per_m = v; });
  const auto effect = [&](const char* name, Stage stage, const char* type, double nominal,
                          double tolerance, residuals::Reach reach, bool zero) {
    const effects::Bounds bounds = bounds_of(type);
    all.push_back({name, stage, actuator.name, nominal, tolerance, nominal + bounds.low, reach,
                   by_effect(type, actuator.name, nominal), type, 1, zero});
    all.back().highest = nominal + bounds.high;
  };
  effect("moment_arm", Stage::routing, "routing_moment_arm", 1, of_moment_arm,
         {.line = true, .chain = a, .path = a}, false);
  effect("line_zero_m", Stage::tendon, "tendon_length_offset", 0, line_zero_m, line, true);
  effect("tension_gain", Stage::sensor, "sensor_tension_gain", 1, of_tension_gain, line, false);
  effect("tension_zero_N", Stage::sensor, "sensor_tension_offset", 0, tension_zero_N, line, true);
  effect("current_gain", Stage::sensor, "sensor_current_gain", 1, of_current_gain, line, false);
  effect("current_zero_A", Stage::sensor, "sensor_current_offset", 0, current_zero_A, line, true);
}

void add_joint(std::vector<Constant>& all, const erp::Joint& joint) {
  const auto number = [&](const char* name, double nominal, double erp::Joint::*field,
                          const char* effect) {
    if (nominal > 0)
      all.push_back({name,
                     Stage::joint,
                     joint.name,
                     nominal,
                     of_joint_friction * nominal,
                     0,
                     {.bones = true},
                     [on = joint.name, field](erp::Robot& r, double value) {
                       joint_of(r, on).*field = value;
                     },
                     effect,
                     1,
                     false,
                     friction_far_sigma});
  };
  number("viscous_Nm_s_per_rad", joint.viscous_Nm_s_per_rad, &erp::Joint::viscous_Nm_s_per_rad,
         "joint_viscous");
  number("coulomb_Nm", joint.coulomb_Nm, &erp::Joint::coulomb_Nm, "joint_coulomb");
  if (joint.type == erp::JointType::revolute) {
    all.push_back({"angle_zero_rad",
                   Stage::sensor,
                   joint.name,
                   0,
                   angle_zero_rad,
                   bounds_of("sensor_joint_offset").low,
                   {.joints = true, .bones = true},
                   by_effect("sensor_joint_offset", joint.name, 0),
                   "sensor_joint_offset",
                   1,
                   true});
    all.back().highest = bounds_of("sensor_joint_offset").high;
  }
}

/// Adds factors of the mass with unchanged distribution, of the distance of its centre, and of the
/// moments of inertia about the centre. They apply to every form in which robot.xml may describe a
/// body.
void add_body(std::vector<Constant>& all, const erp::Robot& robot, const std::string& body) {
  erp::Robot copy = robot;
  const erp::Vec3 com = erp::mass_of(body_of(copy, body)).com_m;
  const double com_m = std::hypot(com[0], com[1], com[2]);
  const auto factor = [&](const char* name, double tolerance, const char* effect,
                          double effect_scale, auto scale) {
    all.push_back({name,
                   Stage::skeleton,
                   body,
                   1,
                   tolerance,
                   smallest_factor,
                   {.bones = true},
                   [body, scale](erp::Robot& r, double value) {
                     if (value == 1) return;
                     erp::Body& b = body_of(r, body);
                     effects::resolve(b);
                     scale(b, value);
                   },
                   effect,
                   effect_scale});
  };
  factor("mass", of_mass, "skeleton_mass", 1,
         [](erp::Body& b, double v) { effects::SkeletonMass{v - 1}.change_body(b); });
  factor("com", of_com, "skeleton_com", com_m,
         [com_m](erp::Body& b, double v) { effects::SkeletonCom{com_m * (v - 1)}.change_body(b); });
  factor("inertia", of_inertia, "skeleton_inertia", 1,
         [](erp::Body& b, double v) { effects::SkeletonInertia{v - 1}.change_body(b); });
}

}  // namespace

/// A step dv of a value v in series leads to v/(1 − dv/v): 1/v changes by −dv/v². Linear beyond 2
/// v.
double Constant::moved(double x, double step) const {
  const double current = value(x), relative = tolerance * step / current;
  if (!in_series || !(current > 0)) return x + step;
  const double factor = relative < 0.5 ? 1 / (1 - relative) : 4 * relative;
  return x + current * (factor - 1) / tolerance;
}

std::vector<Constant> constants_of(const erp::Robot& robot) {
  std::vector<Constant> all;
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    add_motor(all, robot, a);
    const bool line = !robot.actuators[a].tendon.path.empty() && !robot.actuators[a].rope;
    if (line) add_line(all, robot, a);
  }
  for (const erp::Joint& joint : robot.joints())
    if (joint.type == erp::JointType::revolute || joint.type == erp::JointType::spherical)
      add_joint(all, joint);
  for (const erp::Joint& joint : robot.joints())
    if (joint.type != erp::JointType::fixed) add_body(all, robot, joint.child);
  apply_tolerances(all, robot);
  return all;
}

erp::Robot with_constants(const erp::Robot& robot, std::span<const Constant> constants,
                          std::span<const double> x) {
  erp::Robot built = robot;
  for (std::size_t k = 0; k < constants.size(); ++k)
    if (x[k] != 0) constants[k].set(built, constants[k].value(x[k]));
  return built;
}

}  // namespace sim::estimation
