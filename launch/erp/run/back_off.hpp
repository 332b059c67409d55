#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

/// How soon a component that failed is started again:
///
///   delay_k = min(first · 2^k, longest),  k restarts so far within the window; none beyond `most`.
namespace launch {

class BackOff {
 public:
  /// Chosen: a crash costs 0.1 s, a crash loop is given up after about 5 s.
  struct Tuning {
    std::int64_t first_ns = 100'000'000, longest_ns = 2'000'000'000;
    std::int64_t window_ns = 30'000'000'000;
    std::size_t most = 5;
  };

  explicit BackOff(Tuning tuning) : tuning_(tuning) {}

  /// Counts a failure at `now_ns`. Returns the delay until the restart, nothing when given up.
  std::optional<std::int64_t> fail(std::int64_t now_ns) {
    std::erase_if(restarts_ns_, [&](auto then_ns) { return now_ns - then_ns > tuning_.window_ns; });
    const std::size_t k = restarts_ns_.size();
    if (k >= tuning_.most) return std::nullopt;
    restarts_ns_.push_back(now_ns);
    return std::min(tuning_.first_ns << k, tuning_.longest_ns);
  }
  std::size_t restarts_in_window() const { return restarts_ns_.size(); }

 private:
  Tuning tuning_;
  std::vector<std::int64_t> restarts_ns_;
};

}  // namespace launch
