#pragma once
#include <algorithm>
#include <chrono>
#include <numeric>
#include <vector>

namespace bench {

inline double now_us() {
  return 1e-3 * static_cast<double>(std::chrono::steady_clock::now().time_since_epoch().count());
}

/// Measured durations of calls.
struct Durations {
  std::vector<double> durations_us;
  template <class Work>
  void measure(Work&& work) {
    const double begin_us = now_us();
    work();
    durations_us.push_back(now_us() - begin_us);
  }
  /// The duration that the fraction `probability` of the calls does not exceed.
  double quantile_us(double probability) {
    std::ranges::sort(durations_us);
    return durations_us[static_cast<std::size_t>(probability *
                                                 static_cast<double>(durations_us.size() - 1))];
  }
  double mean_us() const {
    return std::accumulate(durations_us.begin(), durations_us.end(), 0.0) /
           static_cast<double>(durations_us.size());
  }
};

}  // namespace bench
