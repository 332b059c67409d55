#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace launch {

/// Name of an enumeration value, or of the bits that are set, in a message of ERP
/// (interfaces/values.hpp). Example: in "erp/msg/ActuatorSample", `mode` 4 is "force" and `valid` 6
/// is "current shaft". Empty for other fields, other values and messages of other packages.
std::string value_name(std::string_view structure, std::string_view field, std::uint64_t value);

}  // namespace launch
