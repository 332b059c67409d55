#include "sim/gap/residuals/band.hpp"

#include <cmath>
#include <numbers>

namespace sim::residuals {

double noise_beyond(double band) {
  constexpr double narrow = 1e-3, wide = 1e3;  // h differs from its limits by less than 0.2 %
  if (band < narrow) return 1;
  if (band > wide) return 0;
  const auto primitive = [](double x) {  // P
    const double phi = std::exp(-x * x / 2) / std::sqrt(2 * std::numbers::pi);
    return ((x * x * x + 3 * x) * std::erfc(-x / std::numbers::sqrt2) / 2 + (x * x + 2) * phi) / 3;
  };
  return (primitive(0) - primitive(-2 * band)) / band;
}

double normalized(const Residual& residual, std::size_t window, double floor) {
  const double z = residual.value[window] / floor;
  if (!banded(residual, window)) return z;
  const double hidden = 1 - noise_beyond(residual.band[window] / floor);
  return std::copysign(std::sqrt(hidden + z * z), z);
}

}  // namespace sim::residuals
