#pragma once
#include "interfaces/robot/robot.hpp"

namespace sim::blind {

/// Torque of the tendons of a joint in one direction, in Nm: half of Σ F_max |∂L/∂q| about its first axis, in
/// the initial pose.
double joint_load_Nm(const erp::Robot& robot, std::size_t joint);

}  // namespace sim::blind
