#pragma once
#include <iosfwd>
#include <string>

#include "launch/erp/learn/training_run.hpp"

namespace launch {

struct SynergyOptions {
  std::string robot, task;
  int seed = 0;     ///< 0: the task's
  int tests = 200;  ///< targets that were not used in the training
  TrainingRunOptions training;
};

/// `erp learn synergy`: trains motor plans by reinforcement in the simulator, then tests the whole
/// bank and parts of it on new targets. Writes bank.xml for the component, its parts bank_50.xml,
/// bank_25.xml, bank_10.xml, tests.csv, figure.svg, curve.csv, curve.svg, state.xml. Returns the
/// exit code; throws as `calibrate_run` does.
int learn_synergy(const SynergyOptions& options, std::ostream& out, std::ostream& remarks);

}  // namespace launch
