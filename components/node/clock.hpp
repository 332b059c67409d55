#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>

#include "interfaces/graph/graph.hpp"
#include "interfaces/steady_time.hpp"

/// The clocks. No other folder reads a clock.
namespace node {

std::int64_t wall_ns();       ///< since 1970; stamps. Steps when a person or a time service sets it
std::int64_t monotonic_ns();  ///< never steps; deadlines, ages and rates

/// Timeout of the wait for a partner that is alive but silent in lockstep. Chosen: longer than any
/// delay of a busy machine, because a timeout makes the run unrepeatable.
inline constexpr std::int64_t lockstep_timeout_ns = 5'000'000'000;

/// The current time of a component. In lockstep both times are the stamp of the current frame, so
/// ages are counted in simulated time and a repeated run is identical.
class Clock {
 public:
  explicit Clock(erp::Time time) : time_(time) {}
  bool lockstep() const { return time_ == erp::Time::lockstep; }
  /// For stamps of messages, which people read: wall time.
  std::int64_t stamp_ns() const { return lockstep() ? simulated_ns_ : wall_ns(); }
  /// For ages, deadlines and rates: monotonic time, which differs from stamps by an unknown offset.
  std::int64_t elapsed_ns() const { return lockstep() ? simulated_ns_ : monotonic_ns(); }
  void advance(std::int64_t stamp_ns) { simulated_ns_ = stamp_ns; }

 private:
  erp::Time time_;
  std::int64_t simulated_ns_ = 0;
};

/// The time since the last message of a sequence, from its stamps: between 0 and `max_s`, even when
/// the clock of the sender is set.
class Interval {
 public:
  /// Chosen: after 50 ms without a command the ECUs have switched off.
  static constexpr double default_max_s = 0.1;
  explicit Interval(double max_s = default_max_s) : max_s_(max_s) {}

  /// 0 for the first message. `elapsed_ns`: time of arrival, of `Clock`.
  double add_s(std::int64_t stamp_ns, std::int64_t elapsed_ns) {
    const std::int64_t now_ns = time_.add(stamp_ns, elapsed_ns);
    const std::int64_t interval_ns = now_ns - last_ns_.value_or(now_ns);
    last_ns_ = now_ns;
    return std::min(1e-9 * static_cast<double>(interval_ns), max_s_);
  }

 private:
  double max_s_;
  erp::SteadyTime time_;
  std::optional<std::int64_t> last_ns_;
};

}  // namespace node
