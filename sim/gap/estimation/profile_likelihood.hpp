#pragma once
#include "sim/gap/estimation/estimate.hpp"

namespace sim::estimation {

/// Sets the variance of each effect parameter to which the residuals are insensitive at the estimate, such as the angle
/// of a stop: its linear standard deviation exceeds the range of its bounds. The standard deviation becomes the larger
/// distance at which the cost has risen by 3.84, divided by 1.96; the other unknowns keep their values. Other
/// variances stay. Source: likelihood-ratio interval, e.g. Pawitan, In All Likelihood, 2001, ch. 2.
void set_profile_variances(const ResidualVector& residuals, const Unknowns& at, Estimate& estimate);

}  // namespace sim::estimation
