#pragma once
#include "interfaces/robot/robot.hpp"
#include "sim/learning/experience/patterns.hpp"

namespace sim::experience {

/// One drive per degree of freedom of the joints. A muscle's share is proportional to the
/// shortening of its line when the joint turns in the starting posture. The largest share is 1. A
/// ball joint has one drive about each of the child's axes. Throws std::invalid_argument like
/// Musculoskeletal.
std::vector<Drive> drives_of(const erp::Robot& robot);

}  // namespace sim::experience
