#pragma once
#include "sim/gap/estimation/estimate.hpp"

namespace sim::estimation {

/// Sets the variance of each effect parameter to which the residuals are insensitive at the
/// estimate. The linear standard deviation of such a parameter exceeds the range of its bounds; an
/// example is the angle of a stop.
///
///   σ = max(d₋, d₊)/1.96      d: distance in each direction at which the cost has risen by 3.84
///
/// The other unknowns are constant. Other variances are not changed.
/// Source: likelihood-ratio interval, e.g. Pawitan, In All Likelihood, 2001, ch. 2.
void set_profile_variances(const ResidualVector& residuals, const Unknowns& at, Estimate& estimate);

}  // namespace sim::estimation
