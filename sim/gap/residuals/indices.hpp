#pragma once
#include <cstddef>
#include <numeric>
#include <vector>

namespace sim {

/// 0 … count − 1.
inline std::vector<std::size_t> each(std::size_t count) {
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace sim
