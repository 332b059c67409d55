#pragma once
#include <iosfwd>
#include <string>

#include "launch/erp/learn/training_run.hpp"
#include "sim/learning/simulated_training/sensorimotor_training.hpp"

/// `erp learn`: trains controllers in the simulator. Each function returns the exit code and throws
/// the same exceptions as `calibrate_run`.
namespace launch {

struct SensorimotorOptions {
  std::string robot, experiment;
  int seed = 0;  ///< 0: the seed of the experiment
  TrainingRunOptions training;
};

/// `erp learn sensorimotor`: runs twitches, then trials at each goal, in the simulator. Writes
/// learned.xml for the component, figure.svg (paper, Fig. 9b and 9d), curve.csv, curve.svg,
/// state.xml.
int learn_sensorimotor(const SensorimotorOptions& options, std::ostream& out,
                       std::ostream& remarks);

/// `erp learn goals`: prints the file of the experiment with its goals replaced by reachable goals.
int learn_goals(const std::string& robot_file, const std::string& experiment_file,
                const sim::simulated_training::GoalDraw& draw, int threads, std::ostream& out);

struct ExperienceOptions {
  std::string robot, task;
  int seed = 0;  ///< 0: the seed of the task
  int tests =
      25;  ///< number of targets that are not in the base; each is tested with each feedback
  TrainingRunOptions training;
};

/// `erp learn experience`: acquires experience in the simulator, then reaches for new targets
/// without feedback, with linear and with fuzzy feedback. Writes base.xml for the component,
/// tests.csv, figure.svg (paper, Fig. 11), curve.csv, curve.svg, state.xml.
int learn_experience(const ExperienceOptions& options, std::ostream& out, std::ostream& remarks);

struct SynergyOptions {
  std::string robot, task;
  int seed = 0;     ///< 0: the seed of the task
  int tests = 200;  ///< number of targets that were not used in the training
  TrainingRunOptions training;
};

/// `erp learn synergy`: trains motor plans by reinforcement in the simulator, then tests the
/// complete bank and parts of it on new targets. Writes bank.xml for the component, its parts
/// bank_50.xml, bank_25.xml, bank_10.xml, tests.csv, figure.svg, curve.csv, curve.svg, state.xml.
int learn_synergy(const SynergyOptions& options, std::ostream& out, std::ostream& remarks);

}  // namespace launch
