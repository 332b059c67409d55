#pragma once
#include <cstdint>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "interfaces/values.hpp"

/// What a robot may be asked to do by a person who wants to know it.
namespace sim {

struct Excitation {
  erp::Mode mode = erp::Mode::length;
  double period_s = 0.002;
  /// By row and actuator, in the mode's unit: N, or the line's change of length in m.
  std::vector<std::vector<double>> reference;
};

inline constexpr int excitation_kinds = 4;  ///< then they come again, with other numbers

/// What the excitation of a recording is like, in words.
const char* excitation_word(const erp::Robot& robot, int recording);

/// One a recording, all different: slow between postures with dwells, tensions that swing and
/// come near slack, low and high co-contraction, fast. Robots of one joint get tensions too.
Excitation excitation(const erp::Robot& robot, int recording, double duration_s,
                      std::uint64_t seed);

}  // namespace sim
