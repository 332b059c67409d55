#pragma once
#include "sim/gap/residuals/episode.hpp"

/// How large a signal is, and how much of that is noise. Samples that were not taken do not count.
namespace sim::residuals {

/// 0: no sample was taken.
double rms(const Signal& signal);

/// The noise of a signal that no data sheet tells of, from its third differences: they leave
/// little of a motion, and 20 times the noise's variance.
double noise_of(const Signal& signal);

}  // namespace sim::residuals
