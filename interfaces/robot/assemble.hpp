#pragma once
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/errors.hpp"

namespace erp {

/// Reads a robot.xml with all included and mirrored parts. Does not check references. Throws
/// xml::Errors with the errors of all files.
Robot assemble_robot(const std::string& file);

/// Reflects a part at y = 0 and renames its elements, according to `<mirror>`.
///
/// With M = diag(1, −1, 1), points and directions become p → M p. Rotation axes are pseudo-vectors:
/// a → −M a. Then M R(a, q) M = R(−M a, q): equal angles give mirror images. Moments of inertia do
/// not change.
Robot mirrored(Robot part, const Mirror& mirror);

}  // namespace erp
