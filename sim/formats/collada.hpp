#pragma once
#include <string>

#include "interfaces/robot/robot.hpp"
#include "sim/formats/linkage.hpp"

/// COLLADA 1.5, the format of the paper's simulator. Standard elements of kinematics and physics contain
/// the skeleton, in degrees and principal axes. An `<extra>` element of profile ERP under the kinematics
/// model contains robot.xml: tendons, motors, sensors, friction, and every number to the last bit.
///
/// If a value of the standard elements differs from the extra by more than rounding, another program has
/// changed it, and it takes precedence. Exceptions, always taken from the extra: solids, starting angles
/// and the mass of root bodies.
namespace formats {

inline constexpr auto collada_namespace = "http://www.collada.org/2008/03/COLLADASchema";
inline constexpr auto erp_profile = "ERP";
inline const std::string erp_prefix = "erp_";  ///< prefix of the element names in the extra

/// Ids are XML names, which must not begin with a digit.
inline std::string joint_id(const std::string& name) { return "joint_" + name; }
inline std::string body_id(const std::string& name) { return "body_" + name; }

/// The robot of the extra with the skeleton of the standard elements. Throws std::invalid_argument if
/// their bodies or joints differ.
erp::Robot with_skeleton(erp::Robot robot, const erp::Robot& standard);

}  // namespace formats
