#pragma once
#include <vector>

#include "sim/gap/estimation/constants.hpp"

namespace sim::estimation {

/// Sets tolerances as robot.xml gives them; a number that is known exactly is no constant. Throws xml::Errors where
/// a <tolerance> names no such number.
void apply_tolerances(std::vector<Constant>& all, const erp::Robot& robot);

}  // namespace sim::estimation
