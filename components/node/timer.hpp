#pragma once
#include <algorithm>
#include <cstdint>

/// Computes when a periodic call is due. Reads no clock.
namespace node {

/// Calls that are overdue by at most `catch_up_ns` are made at twice the rate, so that the
/// receiver can keep up. Calls that are overdue by more are skipped.
class Timer {
 public:
  Timer(std::int64_t period_ns, std::int64_t catch_up_ns, std::int64_t now_ns)
      : period_ns_(period_ns), catch_up_ns_(catch_up_ns) {
    restart(now_ns);
  }

  void restart(std::int64_t now_ns) { due_ns_ = now_ns + period_ns_, ready_ns_ = now_ns; }
  std::int64_t next_ns() const { return std::max(due_ns_, ready_ns_); }
  /// Records the call at `now_ns` (≥ next_ns). Returns the number of calls skipped before it.
  std::int64_t take(std::int64_t now_ns) {
    const auto excess_delay_ns = now_ns - due_ns_ - catch_up_ns_;
    const auto skipped = std::max<std::int64_t>(0, excess_delay_ns / period_ns_);
    due_ns_ += (skipped + 1) * period_ns_;
    ready_ns_ = now_ns + period_ns_ / 2;
    return skipped;
  }

 private:
  std::int64_t period_ns_, catch_up_ns_;
  std::int64_t due_ns_ = 0;    ///< nominal time of the next call
  std::int64_t ready_ns_ = 0;  ///< earliest time of the next call
};

}  // namespace node
