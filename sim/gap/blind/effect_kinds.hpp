#pragma once
#include <functional>
#include <random>
#include <span>

#include "sim/gap/blind/case.hpp"

/// Table of the effects that can be hidden, with their ranges.
namespace sim::blind {

using Random = std::mt19937_64;

/// Randomly chosen parts of the robot. An effect uses the part that its `EffectKind::on` names.
struct Place {
  HiddenEffects& hidden_effects;
  const erp::Robot& robot;
  std::size_t channel = 0, joint = 0;
  std::string body;
  /// Joint load divided by that of hinge_rig. The sizes of joint effects are proportional to it.
  double relative_load = 1;
};

struct EffectKind {
  const char* type;
  const char* stage;
  enum On { channel, joint, body, link, robot } on;  ///< link: a body on a hinge
  /// Draws parameters, sets the hidden effect, returns names and values of the parameters.
  std::vector<std::pair<std::string, double>> (*draw)(Place&, Random&);
  /// Types whose equations can predict nearly the same readings. A withheld case withholds these
  /// types too; otherwise one of them would be a correct answer.
  std::vector<const char*> indistinguishable = {};
};

std::span<const EffectKind> in_library();
std::span<const EffectKind> outside_library();

}  // namespace sim::blind
