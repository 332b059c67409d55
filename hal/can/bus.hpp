#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "firmware/core/frame.h"

namespace erp {

/// A classic CAN frame: 11-bit identifier, up to 8 bytes.
using CanFrame = ::bus_frame;

/// What has become of frames since the bus was opened.
struct BusCounters {
  std::uint64_t sent = 0, received = 0;
  std::uint64_t refused = 0;     ///< not taken: the transmit queue was full
  std::uint64_t unreadable = 0;  ///< received, but no classic data frame of ours
  std::uint64_t errors = 0;      ///< error frames of the controller
  bool off = false;              ///< bus-off or interface down, until restarted or a frame is heard
};

/// One CAN bus, shared by everyone who opens the same one. Own frames are not received.
/// No method throws or touches the heap after opening.
class CanBus {
 public:
  virtual ~CanBus() = default;

  /// Hands frames over in order, without waiting. Returns how many the bus took; the rest is not
  /// kept: what is older than a period must not be sent later.
  virtual std::size_t send(std::span<const CanFrame> frames) = 0;

  /// Waits up to `timeout_s` for a first frame (0: not at all), then takes what is there.
  /// Returns how many frames were filled in; 0 after the timeout, a signal, or a wake-up by
  /// something that was no frame for us.
  virtual std::size_t receive(std::span<CanFrame> frames, double timeout_s) = 0;

  /// Readable when frames wait; then call `receive(frames, 0)` until it returns 0.
  virtual int fd() const = 0;

  virtual BusCounters counters() const = 0;
};

/// Opens a bus: `socketcan:IFACE` (a CAN interface of this machine), or `udp:GROUP:PORT` (frames
/// in multicast datagrams on loopback; for machines without CAN, cannot show bus errors).
/// Throws std::runtime_error with the specification, what is wrong with it, and the remedy.
std::unique_ptr<CanBus> open_bus(const std::string& specification);

}  // namespace erp
