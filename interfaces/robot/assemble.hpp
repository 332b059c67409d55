#pragma once
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/errors.hpp"

namespace erp {

/// A robot.xml with everything it includes and mirrors, references not yet checked.
/// Throws xml::Errors with the mistakes of all its files.
Robot assemble_robot(const std::string& file);

/// Reflects a part at y = 0, renames it and shifts its ecus, as <mirror> says.
///
/// With M = diag(1, −1, 1): points and directions p → M p; rotation axes, which are pseudo-vectors,
/// a → −M a, so that M R(a, q) M = R(−M a, q): the same angle is the mirror image. Principal
/// inertias stay.
Robot mirrored(Robot part, const Mirror& mirror);

}  // namespace erp
