#pragma once
#include <iosfwd>
#include <string>

#include "launch/erp/learn/course.hpp"

namespace launch {

struct SynergyOptions {
  std::string robot, task;
  int seed = 0;     ///< 0: the task's
  int tests = 200;  ///< fresh targets
  CourseOptions course;
};

/// `erp learn synergy`: motor plans learnt by reinforcement in the simulator, then struck at fresh
/// targets with the whole bank and with parts of it. Leaves bank.xml for the component, its parts
/// bank_50.xml, bank_25.xml, bank_10.xml, tests.csv, figure.svg, curve.csv, curve.svg, state.xml.
/// Returns the exit code; throws as `calibrate_run` does.
int learn_synergy(const SynergyOptions& options, std::ostream& out, std::ostream& remarks);

}  // namespace launch
