#pragma once
#include "sim/gap/diagnosis/diagnose.hpp"
#include "sim/gap/diagnosis/direct_detection.hpp"
#include "sim/gap/diagnosis/problem.hpp"

/// Whether the recordings identify what an answer reports.
namespace sim::diagnosis {

/// Drops the alternatives of an answer with a value at a bound: the answer itself could not be supported so.
void drop_alternatives_at_bounds(std::vector<IdentifiedEffect>& answer);
/// Verdict: not identifiable, if a value of a supported answer is not determined by the recordings.
void require_determined(Diagnosis& d);
/// Verdict: not identifiable, if the rows of a drive are too far apart to identify its friction (sampling.hpp).
void require_sampling(const Evaluator& plain, Diagnosis& d);
/// Warns of stages, and of the bus, for which the recordings hold too little data.
void warn_not_evaluated(const Problem& problem, const Detected& detected, Diagnosis& d);

}  // namespace sim::diagnosis
