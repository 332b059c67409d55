#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

/// Delay before a failed component is restarted:
///
///   delay_k = min(initial_delay · 2^k, max_delay),  k: number of restarts within the window.
///
/// If k ≥ max_restarts, the component is not restarted.
namespace launch {

class BackOff {
 public:
  /// Chosen: one crash costs 0.1 s; after about 5 s of repeated crashes there are no more restarts.
  struct Tuning {
    std::int64_t initial_delay_ns = 100'000'000, max_delay_ns = 2'000'000'000;
    std::int64_t window_ns = 30'000'000'000;
    std::size_t max_restarts = 5;
  };

  explicit BackOff(Tuning tuning) : tuning_(tuning) {}

  /// Counts a failure at `now_ns`. Returns the delay until the restart; empty if the limit is
  /// reached.
  std::optional<std::int64_t> on_failure(std::int64_t now_ns) {
    std::erase_if(restarts_ns_,
                  [&](auto restart_ns) { return now_ns - restart_ns > tuning_.window_ns; });
    const std::size_t k = restarts_ns_.size();
    if (k >= tuning_.max_restarts) return std::nullopt;
    restarts_ns_.push_back(now_ns);
    return std::min(tuning_.initial_delay_ns << k, tuning_.max_delay_ns);
  }
  std::size_t restarts_in_window() const { return restarts_ns_.size(); }

 private:
  Tuning tuning_;
  std::vector<std::int64_t> restarts_ns_;
};

}  // namespace launch
