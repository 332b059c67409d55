#pragma once
#include <string>

namespace logger {

/// The IDL source of a message type such as "erp/msg/SensorFrame"; "" for types of other projects.
std::string idl_text(const std::string& message);

}  // namespace logger
