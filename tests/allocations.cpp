#include "tests/allocations.hpp"

#include <atomic>

namespace {
std::atomic<std::size_t> count = 0;
}

std::size_t tests::allocations() { return count; }

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// The allocator of glibc. These names remain available when a program replaces the public
// functions.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) { return ++count, __libc_malloc(size); }
void* calloc(std::size_t n, std::size_t size) { return ++count, __libc_calloc(n, size); }
void* realloc(void* old, std::size_t size) { return ++count, __libc_realloc(old, size); }
void* aligned_alloc(std::size_t align, std::size_t size) {
  return ++count, __libc_memalign(align, size);
}
void* memalign(std::size_t align, std::size_t size) {
  return ++count, __libc_memalign(align, size);
}
}
#endif
