#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "hal/can/bus.hpp"

namespace erp {

/// What waits to be handed to one bus. Of the COMMANDs to an ECU only the newest waits, and not
/// longer than a tick: a set-point must never come out late. Everything else waits in order, after
/// them. So a bus that is slow, full or cut off costs age, not a burst of stale commands.
///
/// Pure: time is an argument, in nanoseconds of any clock. At time 0, which is lockstep's, nothing
/// ages and nothing overtakes: all runs are alike, however slow the bus.
class Outbox {
 public:
  static constexpr std::int64_t max_age_ns = 2'000'000;  ///< of a COMMAND: a tick
  static constexpr std::size_t most_others = 4096;       ///< chosen: all gains of a robot once

  Outbox();

  void put(std::span<const CanFrame> frames, std::int64_t now_ns);
  /// Hands over what the bus takes.
  void flush(CanBus& bus, std::int64_t now_ns);
  /// Forgets everything that waits.
  void drop();
  bool empty() const { return waiting_.empty() && others_.empty(); }

  std::uint64_t replaced() const { return replaced_; }  ///< COMMANDs by newer ones
  std::uint64_t expired() const { return expired_; }    ///< COMMANDs that grew too old
  std::uint64_t dropped() const { return dropped_; }    ///< others: no room, or by `drop`

 private:
  struct Waiting {
    CanFrame frame;
    std::int64_t since_ns;
  };
  void put_command(const CanFrame& frame, std::int64_t now_ns);
  void forget_old(std::int64_t now_ns);
  bool flush_commands(CanBus& bus);
  void flush_others(CanBus& bus);

  std::vector<Waiting> waiting_;  ///< COMMANDs, one an ECU
  std::vector<CanFrame> going_;   ///< their frames, side by side
  std::vector<CanFrame> others_;
  std::uint64_t replaced_ = 0, expired_ = 0, dropped_ = 0;
};

}  // namespace erp
