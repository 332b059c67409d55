#pragma once
#include <cstddef>

namespace tests {

/// Returns the number of memory allocations of this program, by any function. The program must link
/// tests/allocations.cpp. Always 0 under a sanitizer, because a sanitizer has its own allocator.
std::size_t allocations();

}  // namespace tests
