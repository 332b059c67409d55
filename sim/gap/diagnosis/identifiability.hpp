#pragma once
#include "sim/gap/diagnosis/diagnose.hpp"
#include "sim/gap/diagnosis/direct_detection.hpp"
#include "sim/gap/diagnosis/problem.hpp"

/// Whether the recordings determine the values of an answer.
namespace sim::diagnosis {

/// Removes alternatives with a value at a bound. An answer with a value at a bound would not be
/// supported.
void remove_alternatives_at_bounds(std::vector<IdentifiedEffect>& answer);
/// Sets the verdict to not_identifiable if a value of a supported answer is not determined.
void require_determined(Diagnosis& d);
/// Sets the verdict to not_identifiable if the rows of a drive are too far apart to determine its
/// friction (sampling.hpp).
void require_sampling(const Evaluator& baseline, Diagnosis& d);
/// Adds a warning for stages, and for the bus, that were not evaluated because of missing data.
void warn_not_evaluated(const Problem& problem, const Detected& detected, Diagnosis& d);

}  // namespace sim::diagnosis
