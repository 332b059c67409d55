#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>

namespace sim {

/// Standard deviation of each component of a quaternion measured by motion capture; chosen.
inline constexpr double tracking_noise = 2e-4;

/// Normally distributed noise. The same seed gives the same values on every machine.
/// Uniform bits: splitmix64 (Steele, Lea, Flood 2014); normal: Box and Muller 1958.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed) {}

  /// Mean 0, standard deviation 1.
  double normal() {
    if (has_spare_) return has_spare_ = false, spare_;
    const double radius = std::sqrt(-2 * std::log(uniform()));
    const double angle = 2 * std::numbers::pi * uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
  }

  /// In (0, 1].
  double uniform() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>(((z ^ (z >> 31)) >> 11) + 1) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace sim
