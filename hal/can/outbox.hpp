#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "hal/can/bus.hpp"

namespace erp {

/// Transmit queue of one bus. Only the newest COMMAND to an ECU is kept, for at most one tick,
/// because an outdated set-point must not be sent. All other frames wait in order, behind the
/// COMMANDs. On a bus that is slow, full or disconnected, commands are therefore lost instead of
/// sent later in a burst.
///
/// Pure: time is an argument, in nanoseconds of any clock. At time 0, which lockstep uses, frames
/// do not age or overtake: all runs are identical at any speed of the bus.
class Outbox {
 public:
  static constexpr std::int64_t max_age_ns = 2'000'000;  ///< of a COMMAND: one tick
  static constexpr std::size_t max_others = 4096;        ///< chosen: one gain set of a whole robot

  Outbox();

  void put(std::span<const CanFrame> frames, std::int64_t now_ns);
  /// Sends as many frames as the bus accepts.
  void flush(CanBus& bus, std::int64_t now_ns);
  /// Discards all queued frames.
  void drop();
  bool empty() const { return commands_.empty() && others_.empty(); }

  std::uint64_t replaced() const { return replaced_; }  ///< COMMANDs replaced by newer ones
  std::uint64_t expired() const { return expired_; }    ///< COMMANDs discarded because of their age
  std::uint64_t dropped() const { return dropped_; }    ///< other frames: no room, or by `drop`

 private:
  struct QueuedCommand {
    CanFrame frame;
    std::int64_t since_ns;
  };
  void put_command(const CanFrame& frame, std::int64_t now_ns);
  void drop_expired(std::int64_t now_ns);
  bool flush_commands(CanBus& bus);
  void flush_others(CanBus& bus);

  std::vector<QueuedCommand> commands_;  ///< COMMANDs, one per ECU
  std::vector<CanFrame> to_send_;        ///< frames of commands_, contiguous
  std::vector<CanFrame> others_;
  std::uint64_t replaced_ = 0, expired_ = 0, dropped_ = 0;
};

}  // namespace erp
