#pragma once
#include <string>
#include <vector>

#include "sim/diagnosis/skeletal.hpp"

/// Signs and units of a recording, held against the robot's own laws: a wrong one is no gap of the
/// robot, and nothing that is fitted afterwards would mean anything.
///
///   V − R i against K_E N ω,  R i against V − K_E N ω,  path against wound line,  F against
///   stretch: slopes near 1; below 0 a sign is wrong, and at 57.3 times or 1000 times a unit
///
/// Only slopes of signals that go together are believed.
namespace sim::diagnosis {

/// What is odd, one sentence each, with what it looks like; empty: nothing.
std::vector<std::string> odd_units(const Episode& episode, const erp::Robot& robot);

}  // namespace sim::diagnosis
