#pragma once
#include <string>
#include <vector>

#include "sim/residuals/skeletal.hpp"

/// Signs and units of a recording, held against the robot's own laws: a wrong one is no gap of the
/// robot, and nothing that is fitted afterwards would mean anything.
///
///   ω against V/(K_E N)     i against (V − K_E N ω)/R     path against the line paid out, −r θ
///   F against κ (path + r θ)
///
/// A slope is near 1; below 0 a sign is wrong, at 57.3 or 1000 times a unit. Only slopes of signals
/// that go together are believed, and far beyond its stops an angle is taken for degrees. Says
/// nothing of drives.
namespace sim::residuals {

/// What is odd, one sentence each, with what it looks like; empty: nothing.
std::vector<std::string> odd_units(const Episode& episode, const erp::Robot& robot);

}  // namespace sim::residuals
