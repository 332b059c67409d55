#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/can/bus.hpp"
#include "hal/can/bus_recovery.hpp"
#include "hal/can/outbox.hpp"
#include "hal/can/trace.hpp"
#include "interfaces/values.hpp"

namespace erp {

/// A change in the condition of a bus, to be reported.
struct BusNotice {
  Severity severity;
  std::string code, text;
};

/// One bus of the gateway: transmit queue, supervision and recovery.
///
///  - error-warning, error-passive: reported.
///  - bus-off: the queue is dropped, nothing is sent; restarts as in `bus_recovery.hpp`.
///  - no frame leaves for 20 ms: reported (cable open, no ECU powered); the queue is dropped.
///  - down: reported; used again after someone brings the interface up.
///
/// No clock: time is an argument.
class BusKeeper {
 public:
  static constexpr std::int64_t stuck_ns = 20'000'000;  ///< chosen: ten periods

  BusKeeper(std::string name, std::unique_ptr<CanBus> bus)
      : name_(std::move(name)), bus_(std::move(bus)) {}

  const std::string& name() const { return name_; }
  CanBus& bus() { return *bus_; }
  const Outbox& outbox() const { return outbox_; }
  BusCounters counters() const { return bus_->counters(); }
  int restarts() const { return recovery_.restarts(); }
  bool given_up() const { return recovery_.given_up(); }

  /// Writes every frame to `file` from now on. Throws as TraceWriter.
  void record(const std::string& file);
  /// Frames that could not be written to that file.
  std::uint64_t unrecorded() const { return trace_ ? trace_->lost() : 0; }
  /// Sends frames, now or as soon as there is room.
  void post(std::span<const CanFrame> frames, std::int64_t now_ns);
  /// Sends queued frames; call when the bus was readable.
  void flush(std::int64_t now_ns) { post({}, now_ns); }
  /// Checks the bus; call about every millisecond. The result is valid until the next call.
  std::span<const BusNotice> supervise(std::int64_t now_ns);

 private:
  void notice_state(BusState state);
  bool is_stuck(const BusCounters& now, std::int64_t now_ns);
  void notice_stuck(bool stuck);
  void recover(std::int64_t now_ns);
  void notify(Severity severity, std::string code, std::string text) {
    notices_.push_back({severity, std::move(code), std::move(text)});
  }

  std::string name_;
  std::unique_ptr<CanBus> bus_;
  std::unique_ptr<TraceWriter> trace_;
  Outbox outbox_;
  BusRecovery recovery_;
  BusState state_ = BusState::active;
  std::uint64_t sent_on_wire_ = 0;  ///< frames observed on the wire
  /// Time of the last frame on the wire, or when none was in flight.
  std::optional<std::int64_t> last_sent_ns_;
  /// Time of the first missing acknowledgement.
  std::optional<std::int64_t> unacknowledged_since_ns_;
  BusCounters last_counters_;
  bool stuck_ = false;
  std::vector<BusNotice> notices_;
};

}  // namespace erp
