#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace launch {

/// Values of one window and their order statistics; 0 without values.
class Spread {
 public:
  void add(double value) { values_.push_back(value), sorted_ = false; }
  void clear() { values_.clear(); }
  std::size_t count() const { return values_.size(); }

  /// Quantile: the smallest value that is not below a fraction `q` of the values.
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
