#pragma once
#include "sim/diagnosis/diagnose.hpp"
#include "sim/diagnosis/evidence.hpp"
#include "sim/diagnosis/observed.hpp"

/// What an answer is not certain of.
namespace sim::diagnosis {

/// A supported answer with a value that the recordings do not determine is not identifiable.
void doubt_undetermined(Diagnosis& d);
/// Nor is a drive's answer whose rows are too far apart for its friction (sampling.hpp).
void doubt_sampling(const Trials& plain, Diagnosis& d);
/// Warns of the stages, and of the bus, that the recordings show too little of.
void warn_unjudged(const Evidence& evidence, const Observed& observed, Diagnosis& d);

}  // namespace sim::diagnosis
