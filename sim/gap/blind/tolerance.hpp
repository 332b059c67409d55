#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/gap/blind/hidden_effects.hpp"

/// A robot as built: its physical constants deviate slightly from the description.
namespace sim::blind {

/// A drawn constant. `name`: as in robot.xml, with its value. Bodies have the factors "mass" (the
/// moments of inertia are multiplied too), "com" and "inertia" (multiplies the moments again);
/// tendons have the factor "moment_arm".
struct Drawn {
  std::string on, name;
  double value;
};

struct AsBuilt {
  erp::Robot robot;
  std::vector<Drawn> drawn;
};

/// Multiplies every constant by an independent factor 1 + relative·N(0, 1). K_E and K_T have a
/// common factor. Errors of moment arms are written to `hidden_effects`. Sensors are unchanged.
AsBuilt as_built(const erp::Robot& nominal, double relative, std::uint64_t seed,
                 HiddenEffects& hidden_effects);

/// Changes 8 to 12 of these constants by 2 to 10 %, up or down. `drawn` lists all constants.
AsBuilt many_off(const erp::Robot& nominal, std::uint64_t seed, HiddenEffects& hidden_effects);

}  // namespace sim::blind
