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

/// State of the CAN controller (ISO 11898-1: error-active, error-passive, bus-off).
enum class BusState { active, warning, passive, off, down };
const char* name_of(BusState state);

/// Frame counts since the bus was opened.
struct BusCounters {
  std::uint64_t sent = 0, received = 0;
  std::uint64_t refused = 0;         ///< not sent: the transmit queue was full
  std::uint64_t unreadable = 0;      ///< received, but not a data frame of our format
  std::uint64_t errors = 0;          ///< error frames of the controller
  std::uint64_t unacknowledged = 0;  ///< error frames about a missing acknowledgement
  std::uint64_t overrun = 0;         ///< dropped by the kernel: not read fast enough
  BusState state = BusState::active;
  bool off() const { return state == BusState::off || state == BusState::down; }
};

/// Receives every frame of a bus, in the order on the wire.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  /// `stamp_ns` since 1970; `is_own`: sent by this process.
  virtual void frame(const CanFrame& frame, std::int64_t stamp_ns, bool is_own) = 0;
};

/// One CAN bus. All processes that open the same bus share it. Own frames are not received.
/// Only `restart` may throw or use the heap after opening.
class CanBus {
 public:
  virtual ~CanBus() = default;

  /// Sends frames in order, without waiting. Returns how many the bus accepted. The rest is not
  /// queued, because frames older than a period must not be sent later.
  virtual std::size_t send(std::span<const CanFrame> frames) = 0;

  /// Waits up to `timeout_s` for a first frame (0: does not wait), then takes the available frames.
  /// Returns how many were written; 0 after the timeout, a signal, or a frame of another format.
  virtual std::size_t receive(std::span<CanFrame> frames, double timeout_s) = 0;

  /// Readable when frames are waiting; then call `receive(frames, 0)` until it returns 0.
  virtual int fd() const = 0;

  virtual BusCounters counters() const = 0;

  /// Number of accepted frames that have not yet been observed on the wire; 0 if unknown.
  virtual std::size_t in_flight() const { return 0; }

  /// Restarts a bus in bus-off. Throws std::runtime_error with reason and remedy.
  virtual void restart() {}

  /// Passes every frame to `sink` from now on; not owned; null: none.
  virtual void record(FrameSink* sink) = 0;
};

struct BusOptions {
  bool fd = false;  ///< CAN FD: frames travel in bundles (firmware/core/bundle.h)
  /// Largest number of frames in flight. Further frames are accepted only after these have been
  /// observed on the wire, which requires a `receive`. 0: limited by the kernel only.
  std::size_t window = 0;
};

/// Opens a bus: `socketcan:IFACE` (a CAN interface of this machine), `udp:GROUP:PORT` (frames in
/// multicast datagrams on loopback; for machines without CAN; does not model bus errors), or
/// `trace:FILE` (a recording by candump or by TraceWriter, played once at its recorded rate).
/// Throws std::runtime_error with the specification, the error and the remedy.
std::unique_ptr<CanBus> open_bus(const std::string& specification, const BusOptions& options = {});

/// The default bus of a graph and its ECUs on this machine: udp:239.255.42.1:20000. Each ERP_DOMAIN
/// has its own range of 16 ports, one per bus.
std::string default_bus();

}  // namespace erp
