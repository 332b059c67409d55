#pragma once
#include <string>

namespace logger {

/// The IDL that a message of ours was made from, "" for others; by its name "erp/msg/SensorFrame".
std::string idl_text(const std::string& message);

}  // namespace logger
