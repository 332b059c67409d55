#include "sim/gap/residuals/bump.hpp"

#include <Eigen/Core>
#include <cmath>
#include <limits>

namespace sim::residuals {

Bump::Bump(double half_width_s, double period_s) {
  const int reach = std::max(3, static_cast<int>(std::lround(half_width_s / period_s)));
  const auto phi = [&](int j) {
    const double u = double(j) / reach, base = std::max(0.0, 1 - u * u);
    return base * base * base;
  };
  double sum_of_weights = 0;
  for (int j = -reach; j <= reach; ++j) sum_of_weights += phi(j);
  for (int j = -reach; j <= reach; ++j) {
    const double before = phi(j - 1) / sum_of_weights, middle = phi(j) / sum_of_weights,
                 after = phi(j + 1) / sum_of_weights;
    mean_.push_back(middle);
    rate_.push_back((before - after) / (2 * period_s));
    curvature_.push_back((before - 2 * middle + after) / (period_s * period_s));
  }
}

double Bump::sum(const std::vector<double>& weights, std::span<const double> x,
                 std::size_t k) const {
  using Vector = Eigen::Map<const Eigen::VectorXd>;
  const auto count = static_cast<Eigen::Index>(weights.size());
  return Vector(weights.data(), count).dot(Vector(&x[k - reach()], count));
}

std::vector<double> Bump::rates(std::span<const double> x) const {
  std::vector<double> rates(x.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = reach(); k + reach() < x.size(); ++k) rates[k] = rate(x, k);
  return rates;
}

}  // namespace sim::residuals
