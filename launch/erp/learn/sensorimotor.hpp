#pragma once
#include <iosfwd>
#include <string>

#include "launch/erp/learn/course.hpp"
#include "sim/learning/simulated_training/sensorimotor_lesson.hpp"

namespace launch {

struct SensorimotorOptions {
  std::string robot, experiment;
  int seed = 0;  ///< 0: the experiment's
  CourseOptions course;
};

/// `erp learn sensorimotor`: twitches, then tries at each goal, in the simulator. Leaves learnt.xml
/// for the component, figure.svg (paper, Fig. 9b and 9d), curve.csv, curve.svg, state.xml. Returns
/// the exit code; throws as `calibrate_run` does.
int learn_sensorimotor(const SensorimotorOptions& options, std::ostream& out,
                       std::ostream& remarks);

/// `erp learn goals`: prints an experiment's file with goals that can be reached, in place of its
/// own. Returns the exit code.
int learn_goals(const std::string& robot_file, const std::string& experiment_file,
                const sim::simulated_training::GoalDraw& draw, int threads, std::ostream& out);

}  // namespace launch
