#pragma once
#include <cstdint>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "interfaces/values.hpp"

/// Excitation trajectories for the identification of a robot.
namespace sim {

struct Excitation {
  erp::Mode mode = erp::Mode::length;
  double period_s = 0.002;
  /// By row and actuator, in the mode's unit: N, or the line's change of length in m.
  std::vector<std::vector<double>> reference;
};

inline constexpr int excitation_kinds =
    4;  ///< later recordings repeat the kinds with other random values

/// Short description of the excitation of a recording.
const char* excitation_name(const erp::Robot& robot, int recording);

/// The excitation of a recording: slow motion between postures with dwells, oscillating tensions
/// down to nearly slack, low and high co-contraction, or fast motion. Tension excitation is used
/// only for robots with one joint.
Excitation excitation(const erp::Robot& robot, int recording, double duration_s,
                      std::uint64_t seed);

}  // namespace sim
