#pragma once
#include <string_view>

#include "interfaces/recording/error.hpp"
#include "interfaces/recording/type_description.hpp"

namespace recording {

/// Reads `ros2msg` schema text, dependencies (`===`, `MSG: package/Type`) included; constants,
/// default values and comments are passed over, but for ros2msg_text's own of name and unit.
/// `name` is the schema's, "package/msg/Type". Throws RecordingError with name, line, value,
/// remedy.
TypeDescription parse_ros2msg(std::string_view name, std::string_view text);

}  // namespace recording
