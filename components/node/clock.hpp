#pragma once
#include <cstdint>

#include "interfaces/graph/graph.hpp"

/// The clocks. No other folder reads a clock.
namespace node {

std::int64_t wall_ns();       ///< since 1970; stamps
std::int64_t monotonic_ns();  ///< never steps back; deadlines and ages

/// Timeout of the wait for a partner that is alive but silent in lockstep. Chosen: longer than any
/// delay of a busy machine, because a timeout makes the run unrepeatable.
inline constexpr std::int64_t lockstep_timeout_ns = 5'000'000'000;

/// The current time of a component. In lockstep it is the stamp of the current frame, so ages are
/// counted in simulated time and a repeated run is identical.
class Clock {
 public:
  explicit Clock(erp::Time time) : time_(time) {}
  bool lockstep() const { return time_ == erp::Time::lockstep; }
  std::int64_t now_ns() const { return lockstep() ? simulated_ns_ : wall_ns(); }
  void advance(std::int64_t stamp_ns) { simulated_ns_ = stamp_ns; }

 private:
  erp::Time time_;
  std::int64_t simulated_ns_ = 0;
};

}  // namespace node
