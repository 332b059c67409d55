#pragma once
#include <iosfwd>
#include <string>

#include "launch/erp/learn/training_run.hpp"

namespace launch {

struct ExperienceOptions {
  std::string robot, task;
  int seed = 0;    ///< 0: the task's
  int tests = 25;  ///< targets that are not in the base; each is tested with each feedback
  TrainingRunOptions training;
};

/// `erp learn experience`: acquires experience in the simulator, then reaches for new targets
/// without feedback, with linear and with fuzzy feedback. Writes base.xml for the component,
/// tests.csv, figure.svg (paper, Fig. 11), curve.csv, curve.svg, state.xml. Returns the exit code;
/// throws as `calibrate_run` does.
int learn_experience(const ExperienceOptions& options, std::ostream& out, std::ostream& remarks);

}  // namespace launch
