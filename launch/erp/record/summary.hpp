#pragma once
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "interfaces/recording/table.hpp"
#include "interfaces/robot/robot.hpp"
#include "interfaces/values.hpp"

/// Summary of a run from its recording.
namespace launch {

/// Error = measured − target, in the unit of the target, while the ECU is running.
struct Tracking {
  std::string actuator;
  erp::Mode mode = erp::Mode::off;
  double rms = 0, largest = 0;
  std::size_t rows = 0;
};

/// Response to a target with a single step. `rise_s`: time of the measured signal from 10 % to 90 %
/// of the step. `steady_rms`: RMS of the error over the second half of the time after the step.
struct StepResponse {
  std::string actuator;
  erp::Mode mode = erp::Mode::off;
  double previous_target = 0, step_target = 0, at_s = 0;
  std::optional<double> rise_s;  ///< absent: 90 % was not reached
  double overshoot = 0, steady_rms = 0;
};

std::vector<Tracking> tracking(const recording::Table& table);
std::vector<StepResponse> step_responses(const recording::Table& table);

/// The recordings of a run.
struct RecordedRun {
  std::vector<std::string> parts;  ///< files, oldest first; at least one
  erp::Robot robot;
  double active_s =
      -1;  ///< time since all components became active; negative: the device never ran
};
/// Prints the file names; of the last file the tracking errors, step responses, joint errors and the
/// limits that actuators reached (run_quality.hpp). Returns 0, or 1 if that file cannot be read.
int print_summary(const RecordedRun& run, std::ostream& out);

}  // namespace launch
