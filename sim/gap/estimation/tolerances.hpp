#pragma once
#include <vector>

#include "sim/gap/estimation/constants.hpp"

namespace sim::estimation {

/// Sets the tolerances of robot.xml. Removes constants with tolerance 0, which are known exactly.
/// Throws xml::Errors if a `<tolerance>` names no constant of the robot.
void apply_tolerances(std::vector<Constant>& all, const erp::Robot& robot);

}  // namespace sim::estimation
