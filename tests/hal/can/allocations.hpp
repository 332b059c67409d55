#pragma once
#include <cstddef>

namespace can_test {

/// How often this program has called `operator new` so far.
std::size_t allocations();

}  // namespace can_test
