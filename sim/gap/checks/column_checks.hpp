#pragma once
#include <string>
#include <vector>

#include "sim/gap/residuals/episode.hpp"

/// Detects wrong signs, wrong units and dead columns of a recording by the robot's own laws (laws.hpp). Such a defect
/// is no gap of the robot, and it invalidates every later fit.
namespace sim::checks {

/// One message for each defect, with its probable cause and the remedy; empty: no defect found. In this order:
/// constant columns while others change (dead_columns.hpp), angles far beyond a joint's stops, the corrections that
/// make most laws consistent (corrections.hpp), converters at the end of their range.
std::vector<std::string> column_checks(const residuals::Episode& episode, const erp::Robot& robot);

}  // namespace sim::checks
