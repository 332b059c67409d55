#include "components/node/wake.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace node {

Wake::Wake() : descriptor_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}
Wake::~Wake() { close(descriptor_); }

void Wake::raise() {
  const std::uint64_t one = 1;
  // The write fails only if the counter is full. The descriptor is then readable anyway.
  [[maybe_unused]] const auto written = write(descriptor_, &one, sizeof one);
}

void Wake::clear() {
  std::uint64_t count;
  [[maybe_unused]] const auto taken = read(descriptor_, &count, sizeof count);
}

}  // namespace node
