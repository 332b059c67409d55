#pragma once
#include <cstddef>
#include <numeric>
#include <vector>

namespace sim {

/// 0 … count − 1.
inline std::vector<std::size_t> each(std::size_t count) {
  std::vector<std::size_t> indices(count);
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

}  // namespace sim
