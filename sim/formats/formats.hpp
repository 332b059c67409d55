#pragma once
#include <string>

#include "interfaces/robot/robot.hpp"

/// Export and import of robots in other file formats.
namespace formats {

/// The robot as MuJoCo's MJCF: bodies, joints, spatial tendons over sites and wrapping spheres, and
/// one motor per muscle whose control is the tension in N. The starting pose is the keyframe "start".
///
/// Motors, spindles, springs and sensors are not exported, because MJCF has no equivalent. Coulomb friction
/// becomes frictionloss, which MuJoCo softens. A rope becomes a tendon without mass. Throws
/// std::invalid_argument for elements that MJCF cannot express: a pulley directly after another, counted turns.
std::string to_mjcf(const erp::Robot& robot);

/// The skeleton as URDF, with all joints at zero. URDF has no ball joint: a ball joint becomes three hinges
/// over links without mass, each with the range of the total rotation. Muscles, motors, contacts and the
/// starting pose are not exported.
std::string to_urdf(const erp::Robot& robot);
/// The skeleton as SDF 1.7. Omits the same elements, and the limits of ball joints.
std::string to_sdf(const erp::Robot& robot);

/// The whole robot as COLLADA 1.5: see collada.hpp. The same robot always gives the same file.
std::string to_collada(const erp::Robot& robot);
/// The robot of a COLLADA file, bit for bit as it was written. Without the `<extra>` of profile ERP, the
/// skeleton without solids. Throws like from_urdf.
erp::Robot from_collada(const std::string& file);

/// A robot without muscles from a URDF or SDF file: see robot_of in linkage.hpp. Throws xml::Errors with
/// file:line:column for an element that is missing, not a number or not supported; std::invalid_argument.
erp::Robot from_urdf(const std::string& file);
erp::Robot from_sdf(const std::string& file);

/// A picture in SVG: the starting pose from the front and from the robot's right, with names as tooltips.
/// Throws std::invalid_argument like RobotTree and Routing.
std::string to_svg(const erp::Robot& robot);

}  // namespace formats
