#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace launch {

/// Quantiles of the values of one window.
class Spread {
 public:
  void add(double value) { values_.push_back(value), is_sorted_ = false; }
  void clear() { values_.clear(); }
  std::size_t count() const { return values_.size(); }

  /// The smallest value v such that at least a fraction `q` of the values is ≤ v; 0 without values.
  double quantile(double q) {
    if (values_.empty()) return 0;
    if (!is_sorted_) std::sort(values_.begin(), values_.end()), is_sorted_ = true;
    const double rank = std::ceil(q * static_cast<double>(values_.size()));
    return values_[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
  }

 private:
  std::vector<double> values_;
  bool is_sorted_ = false;
};

}  // namespace launch
