#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/gap/blind/tolerance.hpp"

/// A blind case: hidden effects drawn from a seed.
namespace sim::blind {

enum class Kind { single, null, pair, outside, withheld, many };

/// A hidden effect. `type`: name in the library of effects; of laws that the library lacks, a name that
/// begins with "outside_".
struct Hidden {
  std::string type, stage, on;
  std::vector<std::pair<std::string, double>> parameters;
};

struct Case {
  std::uint64_t seed = 0;
  Kind kind = Kind::single;
  std::vector<Hidden> hidden;
  HiddenEffects hidden_effects;
  AsBuilt built;                      ///< `drawn` is empty if the constants are as described
  std::vector<std::string> withhold;  ///< types that the diagnosis may not use
  int drawn_anew = 0;                 ///< number of draws rejected as invisible
};

/// `only`: types to draw from; empty: all. `shows`: whether an effect alone is visible (visibility.hpp);
/// invisible effects are drawn again, at most fifty times. Throws std::invalid_argument for a robot without
/// actuators or revolute joints, and for a type that this kind does not hide.
Case draw_case(const erp::Robot& robot, Kind kind, std::uint64_t seed,
               const std::vector<std::string>& only = {},
               const std::function<bool(const HiddenEffects&)>& shows = {});

const char* word(Kind kind);
/// Throws std::invalid_argument for an unknown name.
Kind kind_of(const std::string& word);

}  // namespace sim::blind
