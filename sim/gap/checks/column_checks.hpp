#pragma once
#include <string>
#include <vector>

#include "sim/gap/residuals/episode.hpp"

/// Signs, units and dead columns of a recording, held against the robot's own laws (laws.hpp): a wrong
/// one is no gap of the robot, and nothing that is fitted afterwards would mean anything.
namespace sim::checks {

/// What is odd, one sentence each, with what it looks like and what to do; empty: nothing. Columns
/// that stand still while others move (dead_columns.hpp), angles far beyond a joint's stops, then
/// what would put most laws right (mending.hpp), then converters at the end of their range (at_limit.hpp).
std::vector<std::string> column_checks(const residuals::Episode& episode, const erp::Robot& robot);

}  // namespace sim::checks
