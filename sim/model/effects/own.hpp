#pragma once
#include "interfaces/robot/robot.hpp"

/// Parts of a robot made ready to be changed alone.
namespace sim::effects {

/// A motor type that no other actuator shares: added to the robot if there is none yet.
erp::MotorType& own_motor(erp::Robot& robot, erp::Actuator& actuator);

/// Gives a body its mass as numbers, whatever solids it was made of.
void resolve(erp::Body& body);

}  // namespace sim::effects
