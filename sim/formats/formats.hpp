#pragma once
#include <string>

#include "interfaces/robot/robot.hpp"

/// Robots in the formats of others.
namespace formats {

/// The robot as MuJoCo's MJCF: bodies, joints, spatial tendons over sites and wrapping spheres, and
/// one motor a muscle whose control is the tension in N. The starting pose is the keyframe "start".
///
/// MJCF has no motor, spindle, spring or sensor of ours: they stay behind. Coulomb friction becomes
/// frictionloss, which MuJoCo softens. Throws std::invalid_argument for a pulley that follows
/// another one, which MJCF cannot say.
std::string to_mjcf(const erp::Robot& robot);

/// A picture: the starting pose from the front and from the robot's right, as SVG; pointing at
/// something shows its name. Throws std::invalid_argument for a robot that cannot be built.
std::string to_svg(const erp::Robot& robot);

}  // namespace formats
