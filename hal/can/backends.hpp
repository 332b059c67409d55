#pragma once
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <ctime>
#include <stdexcept>
#include <utility>

#include "hal/can/bus.hpp"

/// The back ends of `open_bus` and their common parts; inside hal/can only.
namespace erp::can {

std::unique_ptr<CanBus> open_socketcan(const std::string& interface, const BusOptions& options);
std::unique_ptr<CanBus> open_udp(const std::string& group, int port);
std::unique_ptr<CanBus> open_trace(const std::string& file);

/// An open file descriptor, closed once.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }

 private:
  int fd_;
};

/// Waits until `fd` is readable; false after the timeout or a signal.
inline bool wait_readable(int fd, double timeout_s) {
  if (timeout_s <= 0) return true;
  pollfd descriptor{fd, POLLIN, 0};
  const double whole_s = std::floor(timeout_s);
  const timespec timeout{static_cast<std::time_t>(whole_s),
                         static_cast<long>((timeout_s - whole_s) * 1e9)};
  return ::ppoll(&descriptor, 1, &timeout, nullptr) > 0;
}

constexpr std::int64_t to_ns(const timespec& time) {
  return std::int64_t{1'000'000'000} * time.tv_sec + time.tv_nsec;
}

}  // namespace erp::can
