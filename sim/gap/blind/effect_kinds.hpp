#pragma once
#include <functional>
#include <random>
#include <span>

#include "sim/gap/blind/case.hpp"

/// Table of the effects that can be hidden, with their ranges.
namespace sim::blind {

using Random = std::mt19937_64;

/// Place of an effect, for the drawing.
struct Place {
  HiddenEffects& hidden_effects;
  const erp::Robot& robot;
  std::size_t chain = 0, joint = 0;
  std::string body;
  double strength =
      1;  ///< joint load relative to hinge_rig's; sizes of joint effects are proportional
};

struct EffectKind {
  const char* type;
  const char* stage;
  enum On { chain, joint, body, link, robot } on;  ///< link: a body on a hinge
  /// Draws parameters, sets the hidden effect, returns names and values of the parameters.
  std::vector<std::pair<std::string, double>> (*draw)(Place&, Random&);
  /// Types whose equations can predict nearly the same readings. They are withheld with it, otherwise one
  /// of them would be a right answer.
  std::vector<const char*> indistinguishable = {};
};

std::span<const EffectKind> in_library();
std::span<const EffectKind> outside_library();

}  // namespace sim::blind
