#pragma once
#include <string_view>

#include "interfaces/recording/error.hpp"
#include "interfaces/recording/type_description.hpp"

namespace recording {

/// Parses `ros2msg` schema text with its dependencies (`===`, `MSG: package/Type`). Ignores
/// constants, default values and comments, except the comments with name and unit that ros2msg_text
/// writes. `name`: name of the schema, "package/msg/Type". Throws RecordingError with name, line,
/// value, remedy.
TypeDescription parse_ros2msg(std::string_view name, std::string_view text);

}  // namespace recording
