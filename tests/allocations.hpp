#pragma once
#include <cstddef>

namespace tests {

/// How often this program has asked for memory, in whatever way; with tests/allocations.cpp linked.
/// Always 0 under a sanitizer, which has an allocator of its own.
std::size_t allocations();

}  // namespace tests
