#pragma once
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/errors.hpp"

namespace erp {

/// A robot.xml with all included and mirrored parts; references are not checked yet. Throws
/// xml::Errors with the errors of all its files.
Robot assemble_robot(const std::string& file);

/// Reflects a part at y = 0 and renames its elements, according to `<mirror>`.
///
/// With M = diag(1, −1, 1): points and directions p → M p; rotation axes, which are pseudo-vectors,
/// a → −M a, so that M R(a, q) M = R(−M a, q): equal angles are mirror images. Principal inertias do
/// not change.
Robot mirrored(Robot part, const Mirror& mirror);

}  // namespace erp
