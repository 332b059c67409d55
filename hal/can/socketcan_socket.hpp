#pragma once
#include <linux/can.h>
#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <string>

#include "hal/can/backends.hpp"

/// The socket of a SocketCAN bus: its setup, and the metadata of received messages; inside hal/can
/// only.
namespace erp::can {

/// A raw socket on `interface`: 11-bit data frames, error frames, echo of own frames, timestamps,
/// and the kernel's count of dropped frames. `options.window` also limits the kernel's send buffer.
/// Throws std::invalid_argument or std::runtime_error, with the remedy.
Descriptor open_raw(const std::string& interface, const BusOptions& options);

/// Metadata of a received frame.
struct Metadata {
  std::int64_t kernel_ns = 0, hardware_ns = 0;  ///< since 1970; hardware: the controller's clock
  std::uint32_t dropped = 0;                    ///< by the kernel since the socket was opened
};
Metadata metadata_of(msghdr& message);

/// Messages of one sendmmsg or recvmmsg, pointing at their frames.
class Batch {
 public:
  static constexpr std::size_t size = 64;
  Batch();
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;
  /// Resets the buffer lengths that a receive has changed.
  void lend();

  std::array<canfd_frame, size> frames{};
  std::array<mmsghdr, size> messages{};

 private:
  static constexpr std::size_t control_bytes = 256;
  std::array<iovec, size> parts_{};
  alignas(cmsghdr) std::array<std::array<char, control_bytes>, size> control_{};

 public:
  void set_size(std::size_t i, std::size_t bytes) { parts_[i].iov_len = bytes; }
};

}  // namespace erp::can
