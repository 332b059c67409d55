#pragma once
#include <vector>

#include "interfaces/recording/table.hpp"
#include "interfaces/robot/robot.hpp"
#include "interfaces/values.hpp"
#include "sim/actuator/excitation.hpp"

/// A robot under its ECUs, asked what a recording or a plan asks, in the simulator: what would have
/// been recorded.
namespace sim::rehearsal {

/// What an actuator is asked in a tick of the ECUs, 2 ms; a reference of NaN: as before, at the
/// start nothing.
struct Asked {
  erp::Mode mode = erp::Mode::off;
  double reference = 0;  ///< V, m, A or N
};
using Score = std::vector<std::vector<Asked>>;  ///< by tick and actuator
Score score_of(const Excitation& excitation);

/// A table as interfaces/recording has it, a row a tick. The robot's effects act. Starts at the
/// initial pose, at pretension. Throws as World does; std::runtime_error: the motion is not finite.
recording::Table rehearse(const erp::Robot& robot, const Score& score, std::uint64_t seed = 1);

}  // namespace sim::rehearsal
