#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/errors.hpp"
#include "sim/model/effects/all.hpp"

/// The effects as a list: by name, with their parameters, from robot.xml and back.
namespace sim::effects {

/// An effect on something: an actuator, joint, body or the robot, by name.
struct Placed {
  std::string on;
  AnyEffect effect;
};

const About& about(const AnyEffect& effect);
/// "gearbox_coulomb on flexor".
inline std::string name_of(const Placed& placed) {
  return std::string(about(placed.effect).type) + " on " + placed.on;
}
/// Of an effect of a sensor, of which kind.
std::optional<Sense> sense_of(const AnyEffect& effect);
std::string_view word(Stage stage);
std::string_view word(Seat seat);

/// One of each, neutral, in the order of the chain.
const std::vector<AnyEffect>& library();
/// The neutral one of that type.
std::optional<AnyEffect> neutral(std::string_view type);

/// A parameter of an effect. `value` points into the effect.
struct Parameter {
  const char* name;
  double* value;
  Bounds bounds;
  bool fitted;  ///< false: given, because recordings hardly show it
};
std::vector<Parameter> parameters(AnyEffect& effect);

/// What effects of that seat may be on.
std::vector<std::string> places(const erp::Robot& robot, Seat seat);

/// The effects that robot.xml names. Throws xml::Errors: an unknown type, parameter or place, a
/// value outside its bounds.
std::vector<Placed> read_effects(const erp::Robot& robot);
/// As robot.xml has it; parameters at their neutral values are left out.
erp::Effect written(const Placed& placed);

/// A robot with its effects: what changes constants has changed them, the rest is to act.
struct Equipped {
  erp::Robot robot;  ///< names no effects
  std::vector<Placed> acting;
};
/// Throws as `read_effects`, and std::invalid_argument for an effect on a tendon's line when the
/// tendon is a rope.
Equipped equip(const erp::Robot& robot);

}  // namespace sim::effects
