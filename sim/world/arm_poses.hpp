#pragma once
#include <vector>

#include "sim/actuator/holding.hpp"

namespace sim {

/// The fifteen poses configs/arm/poses.csv goes through (chosen; the paper calibrates with
/// fifteen). Neighbours lie close enough for 37 mm/s of line and 1.5 s of way.
std::vector<Pose> arm_poses();

}  // namespace sim
