#pragma once
#include "interfaces/robot/robot.hpp"
#include "sim/learning/experience/patterns.hpp"

namespace sim::experience {

/// A drive of each degree of freedom of the joints: muscles in proportion to how much their lines
/// shorten as it turns, where the robot starts; the most is 1. Of a ball joint one about each of the
/// child's axes. Throws std::invalid_argument as Musculoskeletal does.
std::vector<Drive> drives_of(const erp::Robot& robot);

}  // namespace sim::experience
