#pragma once
#include <string>

#include "interfaces/robot/robot.hpp"
#include "sim/formats/linkage.hpp"

/// COLLADA 1.5, the format of the paper's simulator: the skeleton as kinematics and physics, in the
/// file's standard elements; and under the kinematics model, in <extra> with the profile ERP, the
/// robot.xml itself: tendons, motors, sensors, friction, and every number to its last bit (COLLADA
/// has degrees and principal axes).
///
/// Of what stands in both, the standard elements have the word: where they differ from the extra
/// by more than rounding, another program has changed them. (Not of solids, starting angles and the
/// mass of what stands: those are the extra's.)
namespace formats {

inline constexpr auto collada_namespace = "http://www.collada.org/2008/03/COLLADASchema";
inline constexpr auto erp_profile = "ERP";
inline const std::string erp_prefix = "erp_";  ///< of the names of the extra's elements

/// Ids are XML names, which may not begin with a digit.
inline std::string joint_id(const std::string& name) { return "joint_" + name; }
inline std::string body_id(const std::string& name) { return "body_" + name; }

/// The robot of the extra, with the skeleton that the standard elements give. Throws
/// std::invalid_argument when they name other bodies or joints.
erp::Robot with_skeleton(erp::Robot robot, const erp::Robot& standard);

}  // namespace formats
