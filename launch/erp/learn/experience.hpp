#pragma once
#include <iosfwd>
#include <string>

#include "launch/erp/learn/course.hpp"

namespace launch {

struct ExperienceOptions {
  std::string robot, task;
  int seed = 0;    ///< 0: the task's
  int tests = 25;  ///< reaches to targets that are not in the base, one way after the other
  CourseOptions course;
};

/// `erp learn experience`: experience acquired in the simulator, then reaches to fresh targets with
/// no feedback, linear and fuzzy. Leaves base.xml for the component, tests.csv, figure.svg (paper,
/// Fig. 11), curve.csv, curve.svg, state.xml. Returns the exit code; throws as `calibrate_run` does.
int learn_experience(const ExperienceOptions& options, std::ostream& out, std::ostream& remarks);

}  // namespace launch
