#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/errors.hpp"
#include "sim/model/effects/all.hpp"

/// The list of effects: access by name, parameters, reading from and writing to robot.xml.
namespace sim::effects {

/// An effect on a target: an actuator, a joint, a body or the robot, by name.
struct Placed {
  std::string on;
  AnyEffect effect;
};

const About& about(const AnyEffect& effect);
/// "gearbox_coulomb on flexor".
inline std::string name_of(const Placed& placed) {
  return std::string(about(placed.effect).type) + " on " + placed.on;
}
/// The kind of sensor, for an effect on a sensor.
std::optional<Sense> sense_of(const AnyEffect& effect);
/// Names as in reports: "gearbox", "actuator".
std::string_view word(Stage stage);
std::string_view word(Seat seat);

/// One effect of each type with default parameters, in the order of the chain.
const std::vector<AnyEffect>& library();
/// The effect of a type with default parameters.
std::optional<AnyEffect> neutral(std::string_view type);

/// A parameter of an effect. `value` points into the effect.
struct Parameter {
  const char* name;
  double* value;
  Bounds bounds;
  bool fitted;  ///< false: not estimated, because recordings hardly determine it
};
std::vector<Parameter> parameters(AnyEffect& effect);

/// Names of the robot's possible targets of effects of that kind of target.
std::vector<std::string> places(const erp::Robot& robot, Seat seat);

/// The effects that robot.xml lists. Throws xml::Errors for an unknown type, parameter or target,
/// or a value outside its bounds.
std::vector<Placed> read_effects(const erp::Robot& robot);
/// The element of robot.xml; parameters at their default values are omitted.
erp::Effect written(const Placed& placed);

/// A robot with its effects: effects on constants are applied, the others act in each step.
struct Equipped {
  erp::Robot robot;  ///< without effects
  std::vector<Placed> acting;
};
/// Throws like `read_effects`, and std::invalid_argument for an effect on the line of a tendon that
/// is a rope.
Equipped equip(const erp::Robot& robot);

}  // namespace sim::effects
