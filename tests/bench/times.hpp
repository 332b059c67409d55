#pragma once
#include <algorithm>
#include <chrono>
#include <numeric>
#include <vector>

namespace bench {

inline double now_us() {
  return 1e-3 * static_cast<double>(std::chrono::steady_clock::now().time_since_epoch().count());
}

/// Durations of calls, in µs.
struct Times {
  std::vector<double> us;
  template <class Work>
  void take(Work&& work) {
    const double began = now_us();
    work();
    us.push_back(now_us() - began);
  }
  double at(double share) {
    std::ranges::sort(us);
    return us[static_cast<std::size_t>(share * static_cast<double>(us.size() - 1))];
  }
  double mean() const {
    return std::accumulate(us.begin(), us.end(), 0.0) / static_cast<double>(us.size());
  }
};

}  // namespace bench
