#pragma once
#include "sim/gap/diagnosis/diagnose.hpp"
#include "sim/gap/diagnosis/problem.hpp"

/// The split of recordings into train and held out.
namespace sim::diagnosis {

/// As the options have them, else by conditions alone (split.hpp).
Sets first_sets(const Problem& problem);

/// Recordings of which the first part is in train and the rest is held out.
struct CutRecordings {
  std::vector<Shared> shared;
  std::vector<std::string> warnings;  ///< why each was cut
};

/// Changes the split, unless the options give it, so that train and held out both show each stage that the robot of
/// `by` leaves unexplained; a recording that alone shows one is cut in two. With the robot as described, errors of
/// constants open a stage in every recording; with the robot as built, only recordings that meet, for example, an
/// early stop remain. True: the split changed.
bool split_by_residual(Problem& problem, const Evaluator& by, CutRecordings& cut);

}  // namespace sim::diagnosis
