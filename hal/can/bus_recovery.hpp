#pragma once
#include <cstdint>

namespace erp {

/// Decides when to restart a bus in bus-off: at once, then 100 ms after the last attempt, three
/// times in all. Then the bus stays off, because a fault that persists needs inspection. After ten
/// seconds without bus-off (chosen) the attempts are available again. Pure.
class BusRecovery {
 public:
  enum class Action { nothing, restart, give_up };
  static constexpr int max_restarts = 3;
  static constexpr std::int64_t retry_interval_ns = 100'000'000, recovered_ns = 10'000'000'000;

  /// Call about every millisecond. Returns `give_up` once.
  Action step(bool off, std::int64_t now_ns) {
    if (!off) {
      if (restarts_ > 0 && now_ns - last_ns_ > recovered_ns) restarts_ = 0;
      return Action::nothing;
    }
    if (given_up_ || (restarts_ > 0 && now_ns - last_ns_ < retry_interval_ns))
      return Action::nothing;
    if (restarts_ == max_restarts) return given_up_ = true, Action::give_up;
    ++restarts_;
    last_ns_ = now_ns;
    return Action::restart;
  }
  bool given_up() const { return given_up_; }
  int restarts() const { return restarts_; }

 private:
  int restarts_ = 0;
  std::int64_t last_ns_ = 0;
  bool given_up_ = false;
};

}  // namespace erp
