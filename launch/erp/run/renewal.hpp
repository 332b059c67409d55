#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>

namespace launch {

/// Decides when a graph is started again because its frames have stopped although all its processes
/// run: DDS readers can be disturbed so that they never deliver again, for example by messages with a
/// forged sender. New processes have new readers and writers. Reads no clock.
class Renewal {
 public:
  static constexpr std::int64_t patience_ns = 1'500'000'000;   ///< without frames; chosen
  static constexpr std::int64_t min_retry_ns = 3'000'000'000;  ///< between renewals; chosen
  static constexpr std::int64_t give_up_ns = 120'000'000'000;  ///< since the first; chosen
  static constexpr std::int64_t calm_ns = 5'000'000'000;  ///< with frames: the disturbance is over

  enum class Decision { none, renew, give_up };

  /// `running`: all components are active. `stopped_ns`: time without frames because
  /// the bus is disturbed; 0: it is not.
  Decision update(bool running, std::int64_t stopped_ns, std::int64_t now_ns) {
    if (running && !start_ns_) start_ns_ = now_ns - began_ns_.value_or(now_ns);
    if (!began_ns_) began_ns_ = now_ns;
    if (!running || stopped_ns > 0) calm_since_ns_ = now_ns;
    if (last_ns_ && now_ns - calm_since_ns_ > calm_ns) first_ns_.reset(), last_ns_.reset();
    const bool is_due = running ? stopped_ns > patience_ns : last_ns_ && overdue(now_ns);
    if (!is_due) return Decision::none;
    if (first_ns_ && now_ns - *first_ns_ > give_up_ns) return Decision::give_up;
    if (!first_ns_) first_ns_ = now_ns;
    last_ns_ = now_ns;
    return Decision::renew;
  }

 private:
  /// A start that takes twice as long as the first one is disturbed too.
  bool overdue(std::int64_t now_ns) const {
    return now_ns - *last_ns_ > std::max(min_retry_ns, 2 * start_ns_.value_or(0));
  }
  std::optional<std::int64_t> began_ns_, start_ns_, first_ns_, last_ns_;
  std::int64_t calm_since_ns_ = 0;
};

}  // namespace launch
