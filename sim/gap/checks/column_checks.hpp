#pragma once
#include <string>
#include <vector>

#include "sim/gap/residuals/episode.hpp"

/// Detects wrong signs, wrong units and dead columns of a recording by means of the robot's laws
/// (laws.hpp). A defect of the recording is not a gap of the robot, and it invalidates every later
/// fit.
namespace sim::checks {

/// Returns one message for each defect, with its probable cause and the remedy; empty: no defect.
/// The order is: dead columns (dead_columns.hpp), angles far beyond a joint's stops, wrong columns
/// (corrections.hpp), converters at the end of their range.
std::vector<std::string> column_checks(const residuals::Episode& episode, const erp::Robot& robot);

}  // namespace sim::checks
