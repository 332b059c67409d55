#pragma once
#include <string>

#include "interfaces/robot/robot.hpp"

/// Robots in the formats of others.
namespace formats {

/// The robot as MuJoCo's MJCF: bodies, joints, spatial tendons over sites and wrapping spheres, and
/// one motor a muscle whose control is the tension in N. The starting pose is the keyframe "start".
///
/// MJCF has no motor, spindle, spring or sensor of ours: they stay behind. Coulomb friction becomes
/// frictionloss, which MuJoCo softens. A tendon that is a rope becomes one that finds its path at once. Throws
/// std::invalid_argument for what MJCF cannot say: a pulley that follows another one, counted turns.
std::string to_mjcf(const erp::Robot& robot);

/// The skeleton as URDF, all joints at zero. URDF has no ball joint: it becomes three hinges over
/// links without mass, each as far as the whole turn may go. Muscles, motors, contacts and the
/// starting pose stay behind.
std::string to_urdf(const erp::Robot& robot);
/// The skeleton as SDF 1.7; the same stays behind, and the limits of ball joints.
std::string to_sdf(const erp::Robot& robot);

/// The whole robot as COLLADA 1.5: see collada.hpp. The same robot is always the same file.
std::string to_collada(const erp::Robot& robot);
/// The robot of such a file, bit by bit as it was written; without our <extra>, its skeleton alone,
/// without solids. Throws as from_urdf does.
erp::Robot from_collada(const std::string& file);

/// A robot without muscles from such a file: see robot_of in linkage.hpp. Throws xml::Errors with
/// file:line:column for what is missing, no number or cannot be simulated; std::invalid_argument.
erp::Robot from_urdf(const std::string& file);
erp::Robot from_sdf(const std::string& file);

/// A picture: the starting pose from the front and from the robot's right, as SVG; pointing at
/// something shows its name. Throws std::invalid_argument for a robot that cannot be built.
std::string to_svg(const erp::Robot& robot);

}  // namespace formats
