#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/gap/blind/tolerance.hpp"

/// A blind case: what is hidden in it, drawn from a seed.
namespace sim::blind {

enum class Kind { single, null, pair, outside, withheld, many };

/// Something hidden. `type` as the library of effects calls it; of what the library has not,
/// a name that begins with "outside_".
struct Hidden {
  std::string type, stage, on;
  std::vector<std::pair<std::string, double>> parameters;
};

struct Case {
  std::uint64_t seed = 0;
  Kind kind = Kind::single;
  std::vector<Hidden> hidden;
  HiddenEffects hidden_effects;
  AsBuilt built;                      ///< draws nothing: as it is described
  std::vector<std::string> withhold;  ///< what the diagnosis is told to do without
  int drawn_anew = 0;                 ///< what would not have shown in any reading
};

/// `only`: types to draw from, empty: all. `shows`: of something alone (shows.hpp); what does not
/// is drawn anew, fifty times at most. Throws std::invalid_argument for a robot without actuators
/// or joints, and for a type that this kind never hides.
Case draw_case(const erp::Robot& robot, Kind kind, std::uint64_t seed,
               const std::vector<std::string>& only = {},
               const std::function<bool(const HiddenEffects&)>& shows = {});

const char* word(Kind kind);
/// Throws std::invalid_argument for an unknown word.
Kind kind_of(const std::string& word);

}  // namespace sim::blind
