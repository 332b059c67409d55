#pragma once
#include <cstdint>
#include <string>

/// Durations as text.
namespace launch {

/// Parses "20s", "500ms", "2min", "1.5h"; a number without unit is in seconds.
/// Throws std::invalid_argument for other texts and for values of 0 or less.
double parse_duration_s(const std::string& text);

/// A duration as text, below a minute with at most three significant digits: "0.85 s", "20 s", "2
/// min 05 s".
std::string to_text_s(double duration_s);

}  // namespace launch
