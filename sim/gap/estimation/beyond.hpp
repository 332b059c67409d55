#pragma once
#include "sim/gap/estimation/as_built.hpp"

/// Which constants of a robot as built are beyond their tolerances.
namespace sim::estimation {

/// Under the exact hypothesis: sets `built.beyond` from the estimate.
void list_uncertain(AsBuilt& built);

/// Where all constants are uncertain: identifies those that are far off (far_off.hpp), and estimates all again with
/// that known, until both agree or after four rounds. Those that end near nominal are dropped then.
void complete_far_off(const Estimator& estimator, AsBuilt& built);

}  // namespace sim::estimation
