#pragma once
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "interfaces/recording/table.hpp"
#include "interfaces/values.hpp"

/// What a run achieved, from its recording: how well each actuator followed its target.
namespace launch {

/// Error = measured − target, in the target's unit, while the ECU was running.
struct Tracking {
  std::string actuator;
  erp::Mode mode = erp::Mode::off;
  double rms = 0, largest = 0;
  std::size_t rows = 0;
};

/// The answer to a target that jumps once. Rise: from 10 % to 90 % of the jump, as measured.
/// Steady: RMS of the error over the second half of what follows the jump.
struct StepResponse {
  std::string actuator;
  erp::Mode mode = erp::Mode::off;
  double from = 0, to = 0, at_s = 0;
  std::optional<double> rise_s;  ///< nothing: it never got there
  double overshoot = 0, steady_rms = 0;
};

std::vector<Tracking> tracking(const recording::Table& table);
std::vector<StepResponse> step_responses(const recording::Table& table);

/// What a run left.
struct RecordedRun {
  std::vector<std::string> parts;  ///< its recordings, oldest first; at least one
  std::string robot;
  double lasted_s = -1;  ///< from the first moment all were active; negative: nothing moved
};
/// Names the recordings and prints tracking and step responses of the last one. Returns 0, or 1
/// when it cannot be read.
int print_summary(const RecordedRun& run, std::ostream& out);

}  // namespace launch
