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

/// What the controller says of itself (ISO 11898-1: error-active, -passive, bus-off).
enum class BusState { active, warning, passive, off, down };
const char* name_of(BusState state);

/// What has become of frames since the bus was opened.
struct BusCounters {
  std::uint64_t sent = 0, received = 0;
  std::uint64_t refused = 0;         ///< not taken: the transmit queue was full
  std::uint64_t unreadable = 0;      ///< received, but no data frame of ours
  std::uint64_t errors = 0;          ///< error frames of the controller
  std::uint64_t unacknowledged = 0;  ///< of these: nobody on the bus acknowledged
  std::uint64_t overrun = 0;         ///< dropped by the kernel: we were too slow to read
  BusState state = BusState::active;
  bool off() const { return state == BusState::off || state == BusState::down; }
};

/// Hears every frame of a bus, as it was on the wire.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  /// `stamp_ns` since 1970; `own`: sent by us.
  virtual void frame(const CanFrame& frame, std::int64_t stamp_ns, bool own) = 0;
};

/// One CAN bus, shared by everyone who opens the same one. Own frames are not received.
/// No method but `restart` throws or touches the heap after opening.
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

  /// Readable when something waits; then call `receive(frames, 0)` until it returns 0.
  virtual int fd() const = 0;

  virtual BusCounters counters() const = 0;

  /// Frames taken and not yet seen on the wire; 0 where that cannot be known.
  virtual std::size_t in_flight() const { return 0; }

  /// Brings a bus that is off back on. Throws std::runtime_error with reason and remedy.
  virtual void restart() {}

  /// Lets `sink` hear every frame from now on; lent, or null for nobody.
  virtual void record(FrameSink* sink) = 0;
};

struct BusOptions {
  bool fd = false;  ///< CAN FD: frames travel in bundles (firmware/core/bundle.h)
  /// Frames that may be in flight; more are not taken until these are seen on the wire, which takes
  /// a `receive`. 0: no bound but the kernel's.
  std::size_t window = 0;
};

/// Opens a bus: `socketcan:IFACE` (a CAN interface of this machine), `udp:GROUP:PORT` (frames in
/// multicast datagrams on loopback; for machines without CAN, cannot show bus errors), or
/// `trace:FILE` (a recording by candump, or our own, played once at its own pace).
/// Throws std::runtime_error with the specification, what is wrong with it, and the remedy.
std::unique_ptr<CanBus> open_bus(const std::string& specification, const BusOptions& options = {});

/// The bus of this machine that a graph and its ECUs meet on where nothing else is said:
/// udp:239.255.42.1:20000, and 16 ports on, one a bus, for each ERP_DOMAIN.
std::string own_bus();

}  // namespace erp
