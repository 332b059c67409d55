#pragma once
#include "sim/gap/estimation/as_built.hpp"

/// Which constants of a robot as built are beyond their tolerances.
namespace sim::estimation {

/// Sets `built.beyond` from the estimate, under the exact hypothesis.
void list_uncertain(AsBuilt& built);

/// Under the hypothesis that all constants are uncertain: identifies those that are far off (far_off.hpp) and estimates
/// all again with that set, until the set stays the same or for four rounds. Then removes constants that end near
/// nominal from the set.
void complete_far_off(const Estimator& estimator, AsBuilt& built);

}  // namespace sim::estimation
