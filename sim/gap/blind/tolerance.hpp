#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/gap/blind/hidden_effects.hpp"

/// A robot as built: its physical numbers are those of its description, each a little off.
namespace sim::blind {

/// A number as drawn: `name` as in robot.xml; of a body "mass" (spread as before), "com" and "inertia" (of the moments
/// that it then has), and of a tendon "moment_arm", as factors.
struct Drawn {
  std::string on, name;
  double value;
};

struct AsBuilt {
  erp::Robot robot;
  std::vector<Drawn> drawn;
};

/// Every number times 1 + relative·N(0, 1), each its own; K_E and K_T share one. Moment arms go into
/// `quirks`. Sensors are what they are said to be.
AsBuilt as_built(const erp::Robot& nominal, double relative, std::uint64_t seed,
                 HiddenEffects& hidden_effects);

/// 8 to 12 of the same numbers 2 to 10 % too large or too small, all others as described; all are in `drawn`.
AsBuilt many_off(const erp::Robot& nominal, std::uint64_t seed, HiddenEffects& hidden_effects);

}  // namespace sim::blind
