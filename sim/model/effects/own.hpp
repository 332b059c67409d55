#pragma once
#include "interfaces/robot/robot.hpp"

/// Makes a part of a robot independent of other parts. It can then be changed separately.
namespace sim::effects {

/// The motor type of an actuator, not shared with other actuators; added to the robot if necessary.
erp::MotorType& own_motor(erp::Robot& robot, erp::Actuator& actuator);

/// Replaces a body's solids by explicit mass, centre of mass and inertia.
void resolve(erp::Body& body);

}  // namespace sim::effects
