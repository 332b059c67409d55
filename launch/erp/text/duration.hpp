#pragma once
#include <cstdint>
#include <string>

/// Durations as people write and read them.
namespace launch {

/// "20s", "500ms", "2min", "1.5h"; without a unit, seconds.
/// Throws std::invalid_argument for anything else, zero and negative included.
double parse_duration_s(const std::string& text);

/// Short, three figures: "0.85 s", "20 s", "2 min 05 s".
std::string to_text_s(double duration_s);

}  // namespace launch
