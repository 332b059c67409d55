#include "sim/gap/residuals/signal_noise.hpp"

#include <algorithm>
#include <cmath>

namespace sim::residuals {

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double rms(const Signal& signal) {
  double square = 0, count = 0;
  for (const double x : signal)
    if (!std::isnan(x)) square += x * x, ++count;
  return count > 0 ? std::sqrt(square / count) : 0;
}

double noise_of(const Signal& signal) {
  std::vector<double> square;
  for (std::size_t k = 3; k < signal.size(); ++k)
    if (const double d = signal[k] - 3 * signal[k - 1] + 3 * signal[k - 2] - signal[k - 3];
        !std::isnan(d))
      square.push_back(d * d);
  if (square.empty()) return 0;
  constexpr double median_of_chi_square = 0.455, variance_factor = 20;  // 1 + 9 + 9 + 1
  return std::sqrt(median(square) / variance_factor / median_of_chi_square);
}

}  // namespace sim::residuals
