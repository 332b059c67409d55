#pragma once
#include <functional>
#include <random>
#include <span>

#include "sim/gap/blind/case.hpp"

/// What may be hidden, and how large: a table.
namespace sim::blind {

using Random = std::mt19937_64;

/// Where it sits, for the drawing.
struct Place {
  HiddenEffects& hidden_effects;
  const erp::Robot& robot;
  std::size_t chain = 0, joint = 0;
  std::string body;
  double stronger = 1;  ///< the joint, than hinge_rig's: what brakes or loads it is in proportion
};

struct EffectKind {
  const char* type;
  const char* stage;
  enum On { chain, joint, body, link, robot } on;  ///< link: a body on a hinge
  /// Draws, sets the quirk and tells what was drawn.
  std::vector<std::pair<std::string, double>> (*draw)(Place&, Random&);
  /// Types that foretell nearly the same readings with some parameters of theirs, by their
  /// equations: they are withheld with it, or the right answer would be the twin.
  std::vector<const char*> twins = {};
};

std::span<const EffectKind> in_library();
std::span<const EffectKind> outside_library();

}  // namespace sim::blind
