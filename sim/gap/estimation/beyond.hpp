#pragma once
#include "sim/gap/estimation/as_built.hpp"

/// Lists the constants of a robot as built that are beyond their tolerances.
namespace sim::estimation {

/// Sets `built.beyond_tolerance` from the estimate, under the hypothesis that all other constants
/// are exact.
void list_uncertain(AsBuilt& built);

/// Under the hypothesis that all constants are uncertain: selects the constants that are far off
/// (far_off.hpp) and estimates all constants with that selection, until it does not change or for
/// four rounds. Then removes constants whose estimate is near nominal from the selection.
void complete_far_off(const Estimator& estimator, AsBuilt& built);

}  // namespace sim::estimation
