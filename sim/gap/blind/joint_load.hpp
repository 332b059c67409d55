#pragma once
#include "interfaces/robot/robot.hpp"

namespace sim::blind {

/// Largest torque of the tendons about the first axis of a joint in one direction, in Nm, in the
/// initial pose. τ = ½ Σ F_max |∂L/∂q| over all tendons: about half of the tendons pull in each
/// direction.
double joint_load_Nm(const erp::Robot& robot, std::size_t joint);

}  // namespace sim::blind
