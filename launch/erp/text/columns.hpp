#pragma once
#include <cstddef>
#include <string>
#include <vector>

/// Text in columns. Pure.
namespace launch {

/// Cells padded to the widest of their column.
std::vector<std::string> align(const std::vector<std::vector<std::string>>& rows,
                               const std::vector<bool>& right_aligned);

/// At most `width` characters of UTF-8 text.
std::string clipped(const std::string& text, std::size_t width);

}  // namespace launch
