#pragma once
#include "sim/gap/residuals/episode.hpp"

/// Median, rms and noise of a signal. Missing samples do not count.
namespace sim::residuals {

/// The larger of the two middle values if their number is even. Reorders `values`; one at least, none
/// missing.
double median(std::vector<double>& values);

/// 0 without samples.
double rms(const Signal& signal);

/// Noise of a signal without a data sheet, in its unit (standard deviation), from its third differences: they remove
/// nearly all motion and have 20 times the noise's variance.
double noise_of(const Signal& signal);

}  // namespace sim::residuals
