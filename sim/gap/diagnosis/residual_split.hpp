#pragma once
#include "sim/gap/diagnosis/diagnose.hpp"
#include "sim/gap/diagnosis/problem.hpp"

/// Split into training and held-out recordings by their residuals.
namespace sim::diagnosis {

/// The sets given by the options, otherwise the split by conditions alone (split.hpp).
Sets first_sets(const Problem& problem);

/// Recordings whose first part is used for training and whose rest is held out.
struct CutRecordings {
  std::vector<Shared> shared;
  std::vector<std::string> warnings;  ///< why each was cut
};

/// Changes the split, unless the options define it, so that both sets show each stage that the robot of `by` leaves
/// open. If one recording alone shows a stage, it is split in two. With the robot as described, errors of
/// constants open a stage in every recording; with the robot as built, only recordings with the effect itself, for
/// example an early stop, do. Returns whether the split changed.
bool split_by_residual(Problem& problem, const Evaluator& by, CutRecordings& cut);

}  // namespace sim::diagnosis
