#pragma once
#include <cstddef>
#include <string>
#include <vector>

/// Text tables.
namespace launch {

/// One line per row. Each cell is padded to the width of the widest cell in its column.
std::vector<std::string> align(const std::vector<std::vector<std::string>>& rows,
                               const std::vector<bool>& right_aligned);

/// A number in a printf format with one floating-point conversion, for example "%.1f Hz".
std::string decimal(const char* format, double value);

/// The first `width` characters of a UTF-8 text.
std::string clipped(const std::string& text, std::size_t width);

}  // namespace launch
