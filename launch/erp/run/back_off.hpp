#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

/// Delay before a failed component is restarted:
///
///   delay_k = min(first · 2^k, longest),  k: restarts within the window;
///
/// no restart if k ≥ max_restarts.
namespace launch {

class BackOff {
 public:
  /// Chosen: one crash costs 0.1 s, a crash loop is abandoned after about 5 s.
  struct Tuning {
    std::int64_t first_ns = 100'000'000, longest_ns = 2'000'000'000;
    std::int64_t window_ns = 30'000'000'000;
    std::size_t max_restarts = 5;
  };

  explicit BackOff(Tuning tuning) : tuning_(tuning) {}

  /// Counts a failure at `now_ns`. Returns the delay until the restart, or nothing if the limit is
  /// reached.
  std::optional<std::int64_t> fail(std::int64_t now_ns) {
    std::erase_if(restarts_ns_, [&](auto then_ns) { return now_ns - then_ns > tuning_.window_ns; });
    const std::size_t k = restarts_ns_.size();
    if (k >= tuning_.max_restarts) return std::nullopt;
    restarts_ns_.push_back(now_ns);
    return std::min(tuning_.first_ns << k, tuning_.longest_ns);
  }
  std::size_t restarts_in_window() const { return restarts_ns_.size(); }

 private:
  Tuning tuning_;
  std::vector<std::int64_t> restarts_ns_;
};

}  // namespace launch
