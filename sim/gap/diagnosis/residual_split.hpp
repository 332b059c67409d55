#pragma once
#include "sim/gap/diagnosis/diagnose.hpp"
#include "sim/gap/diagnosis/problem.hpp"

/// Split into training and held-out recordings by their residuals.
namespace sim::diagnosis {

/// Returns the sets given by the options, otherwise the split by the range of the signals
/// (split.hpp).
Sets first_sets(const Problem& problem);

/// Recordings whose first part is used for training and whose second part is held out.
struct CutRecordings {
  std::vector<SplitRecording> split_recordings;
  std::vector<std::string> warnings;  ///< why each was cut
};

/// Changes the split, unless the options define it: both sets must show each stage that is open
/// with the robot of `evaluator`. If only one recording shows a stage, it is split in two. With the
/// robot as described, errors of constants open a stage in every recording. With the robot as
/// built, a stage is open only in recordings with the effect itself, for example an early stop.
/// Returns whether the split changed.
bool split_by_residual(Problem& problem, const Evaluator& evaluator, CutRecordings& cut);

}  // namespace sim::diagnosis
