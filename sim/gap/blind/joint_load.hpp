#pragma once
#include "interfaces/robot/robot.hpp"

namespace sim::blind {

/// The torque that the tendons of a joint can turn it with, either way, Nm: half of Σ F_max |∂L/∂q|
/// along its first axis, at the start.
double joint_load_Nm(const erp::Robot& robot, std::size_t joint);

}  // namespace sim::blind
