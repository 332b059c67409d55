#pragma once
#include <vector>

#include "interfaces/recording/table.hpp"
#include "interfaces/robot/robot.hpp"
#include "sim/control/excitation.hpp"
#include "sim/gap/closed_loop/learned_ecu.hpp"
#include "sim/world/simulated_robot.hpp"

/// Predicted run: simulates a robot with its ECUs and given set-points, and returns the resulting
/// recording.
namespace sim::closed_loop {

/// By tick and actuator. A reference of NaN means the previous set-point; before the first one
/// there is no set-point.
using SetPoints = std::vector<std::vector<SetPoint>>;
SetPoints set_points_of(const Excitation& excitation);

/// Configuration of the ECUs.
struct Ecus {
  /// The robot for which the gains are designed; null: the simulated robot.
  const erp::Robot* configured = nullptr;
  const LearnedEcu* learned = nullptr;  ///< laws that replace those of the firmware, or null
};

/// Returns a table with the columns of a recording (interfaces/recording), one row per tick. The
/// robot's effects are simulated. The run starts in the initial pose at pretension. Throws the
/// exceptions of World, and std::runtime_error if the motion is not finite.
recording::Table predict_run(const erp::Robot& robot, const SetPoints& set_points,
                             std::uint64_t seed = 1, const Ecus& ecus = {});

}  // namespace sim::closed_loop
