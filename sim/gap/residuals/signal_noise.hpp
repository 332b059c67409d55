#pragma once
#include "sim/gap/residuals/episode.hpp"

/// Median, rms and noise of a signal. Missing samples are ignored.
namespace sim::residuals {

/// Median; of an even number of values the larger middle one. Reorders `values`: at least one,
/// without NaN.
double median(std::vector<double>& values);

/// Root mean square; 0 without samples.
double rms(const Signal& signal);

/// Standard deviation of the noise of a signal, in its unit, from its third differences d. They
/// remove nearly all motion and have 20 times the variance of the noise:
///
///   σ² = median(d²)/(20 · 0.455)      0.455: median of χ² with one degree of freedom
double noise_of(const Signal& signal);

}  // namespace sim::residuals
