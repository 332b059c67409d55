#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace launch {

/// What the small numbers of our messages mean (interfaces/values.hpp): in "erp/msg/ActuatorSample"
/// a `mode` of 4 is "force", `valid` 6 is "current shaft". Empty for any other field or number, and
/// for messages of others.
std::string meaning_of(std::string_view structure, std::string_view field, std::uint64_t value);

}  // namespace launch
