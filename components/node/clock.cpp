#include "components/node/clock.hpp"

#include <chrono>

namespace node {

template <class C>
static std::int64_t ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(C::now().time_since_epoch()).count();
}
std::int64_t wall_ns() { return ns<std::chrono::system_clock>(); }
std::int64_t monotonic_ns() { return ns<std::chrono::steady_clock>(); }

}  // namespace node
