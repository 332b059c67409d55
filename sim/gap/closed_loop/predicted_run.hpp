#pragma once
#include <vector>

#include "interfaces/recording/table.hpp"
#include "interfaces/robot/robot.hpp"
#include "sim/control/excitation.hpp"
#include "sim/gap/closed_loop/learned_ecu.hpp"
#include "sim/world/simulated_robot.hpp"

/// Predicted run: simulates a robot under its ECUs with given set-points and returns the recording that results.
namespace sim::closed_loop {

/// By tick and actuator. A reference of NaN keeps the previous set-point; at the start there is none.
using SetPoints = std::vector<std::vector<SetPoint>>;
SetPoints set_points_of(const Excitation& excitation);

/// Configuration of the ECUs.
struct Ecus {
  const erp::Robot* configured =
      nullptr;  ///< robot for which gains are designed; null: the simulated one
  const LearnedEcu* learned = nullptr;  ///< laws that replace the firmware's
};

/// Returns a table with the columns of a recording (interfaces/recording), one row per tick. The robot's effects
/// are simulated. Starts in the initial pose at pretension. Throws as World, and std::runtime_error if the motion
/// is not finite.
recording::Table predict_run(const erp::Robot& robot, const SetPoints& set_points,
                             std::uint64_t seed = 1, const Ecus& ecus = {});

}  // namespace sim::closed_loop
