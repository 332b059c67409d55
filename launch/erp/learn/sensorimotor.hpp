#pragma once
#include <iosfwd>
#include <string>

#include "launch/erp/learn/training_run.hpp"
#include "sim/learning/simulated_training/sensorimotor_training.hpp"

namespace launch {

struct SensorimotorOptions {
  std::string robot, experiment;
  int seed = 0;  ///< 0: the experiment's
  TrainingRunOptions training;
};

/// `erp learn sensorimotor`: runs twitches, then trials at each goal, in the simulator. Writes
/// learned.xml for the component, figure.svg (paper, Fig. 9b and 9d), curve.csv, curve.svg,
/// state.xml. Returns the exit code; throws as `calibrate_run` does.
int learn_sensorimotor(const SensorimotorOptions& options, std::ostream& out,
                       std::ostream& remarks);

/// `erp learn goals`: prints the experiment's file with reachable goals in place of its own.
/// Returns the exit code.
int learn_goals(const std::string& robot_file, const std::string& experiment_file,
                const sim::simulated_training::GoalDraw& draw, int threads, std::ostream& out);

}  // namespace launch
