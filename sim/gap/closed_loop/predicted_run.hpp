#pragma once
#include <vector>

#include "interfaces/recording/table.hpp"
#include "interfaces/robot/robot.hpp"
#include "sim/control/excitation.hpp"
#include "sim/gap/closed_loop/learned_ecu.hpp"
#include "sim/world/simulated_robot.hpp"

/// A robot under its ECUs, asked what a recording or a plan asks, in the simulator: what would have
/// been recorded.
namespace sim::closed_loop {

/// By tick and actuator; a reference of NaN: as before, at the start nothing.
using SetPoints = std::vector<std::vector<SetPoint>>;
SetPoints set_points_of(const Excitation& excitation);

/// Whose ECUs they are.
struct Ecus {
  const erp::Robot* configured =
      nullptr;                          ///< the robot that gains are designed for; null: this one
  const LearnedEcu* learned = nullptr;  ///< laws that take the place of the firmware's
};

/// A table as interfaces/recording has it, a row a tick. The robot's effects act. Starts at the
/// initial pose, at pretension. Throws as World does; std::runtime_error: the motion is not finite.
recording::Table predict_run(const erp::Robot& robot, const SetPoints& score,
                             std::uint64_t seed = 1, const Ecus& ecus = {});

}  // namespace sim::closed_loop
