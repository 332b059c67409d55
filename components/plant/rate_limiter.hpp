#pragma once
#include <cmath>
#include <limits>

namespace plant {

/// Limits the rate of change of a reference:  r ← r + clamp(target − r, ± rate dt).
class RateLimiter {
 public:
  static constexpr double unlimited = std::numeric_limits<double>::infinity();

  void reset(double value) { value_ = value; }
  double step(double target, double rate_per_s, double dt_s) {
    const double limit = rate_per_s * dt_s;
    if (rate_per_s == unlimited || std::abs(target - value_) <= limit) return value_ = target;
    return value_ += target > value_ ? limit : -limit;
  }
  double value() const { return value_; }

 private:
  double value_ = 0;
};

}  // namespace plant
