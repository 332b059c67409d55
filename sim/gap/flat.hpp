#pragma once
#include "sim/gap/estimate.hpp"

namespace sim::gap {

/// Sets the variance of each effect's parameter that changes nothing where the estimate ended, as a stop's place within
/// the reach of its give: its deviation is the farther way to where the cost has risen by 3.84, over 1.96 (profile
/// likelihood, the other unknowns as they are). Others keep theirs.
void set_flat_variances(const ResidualVector& residuals, const Unknowns& at, Estimate& estimate);

}  // namespace sim::gap
