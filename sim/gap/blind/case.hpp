#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/gap/blind/tolerance.hpp"

/// A blind case: a robot with hidden effects that are drawn from a seed.
namespace sim::blind {

enum class Kind { single, null, pair, outside, withheld, many };

/// A hidden effect. `type`: name in the library of effects. The name of a law that the library
/// lacks begins with "outside_". `on`: name of the actuator, joint, body or robot.
struct Hidden {
  std::string type, stage, on;
  std::vector<std::pair<std::string, double>> parameters;
};

struct Case {
  std::uint64_t seed = 0;
  Kind kind = Kind::single;
  std::vector<Hidden> hidden;
  HiddenEffects hidden_effects;
  AsBuilt built;                      ///< `drawn` is empty if the constants are as in robot.xml
  std::vector<std::string> withhold;  ///< types that the diagnosis may not use
  int rejected_draws = 0;             ///< number of draws rejected as invisible
};

/// `only`: types to draw from; empty: all. `is_visible`: whether a single effect is visible
/// (visibility.hpp). Invisible effects are drawn again, at most fifty times in a case. Throws
/// std::invalid_argument for a robot without actuators or revolute joints, and for a type that this
/// kind does not hide.
Case draw_case(const erp::Robot& robot, Kind kind, std::uint64_t seed,
               const std::vector<std::string>& only = {},
               const std::function<bool(const HiddenEffects&)>& is_visible = {});

/// Name of a kind on the command line.
const char* word(Kind kind);
/// Throws std::invalid_argument for an unknown name.
Kind kind_of(const std::string& word);

}  // namespace sim::blind
