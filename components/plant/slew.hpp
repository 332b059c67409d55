#pragma once
#include <cmath>
#include <limits>

namespace plant {

/// A reference that moves no faster than it may:  r ← r + clamp(wanted − r, ± rate dt).
class Slew {
 public:
  static constexpr double free = std::numeric_limits<double>::infinity();

  void start(double at) { at_ = at; }
  double towards(double wanted, double rate_per_s, double dt_s) {
    const double step = rate_per_s * dt_s;
    if (rate_per_s == free || std::abs(wanted - at_) <= step) return at_ = wanted;
    return at_ += wanted > at_ ? step : -step;
  }
  double at() const { return at_; }

 private:
  double at_ = 0;
};

}  // namespace plant
