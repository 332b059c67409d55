#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace launch {

/// Durations of one window, and their order statistics. Empty: all zero.
class Spread {
 public:
  void add(double value) { values_.push_back(value), sorted_ = false; }
  void clear() { values_.clear(); }
  std::size_t count() const { return values_.size(); }

  /// The smallest value that at least a fraction `q` of the values does not exceed.
  double quantile(double q) {
    if (values_.empty()) return 0;
    if (!sorted_) std::sort(values_.begin(), values_.end()), sorted_ = true;
    const double rank = std::ceil(q * static_cast<double>(values_.size()));
    return values_[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
  }

 private:
  std::vector<double> values_;
  bool sorted_ = false;
};

}  // namespace launch
