#include "sim/residuals/bump.hpp"

#include <cmath>
#include <limits>

namespace sim::residuals {

Bump::Bump(double half_width_s, double period_s) {
  const int reach = std::max(2, static_cast<int>(std::lround(half_width_s / period_s)) - 1);
  const double width = (reach + 1) * period_s;
  double whole = 0, linear = 0;
  for (int j = -reach; j <= reach; ++j) {
    const double t = j * period_s, u = t / width, inside = 1 - u * u;
    mean_.push_back(inside * inside * inside);
    rate_.push_back(6 * u * inside * inside);       // −φ̇, up to a factor
    bend_.push_back(6 * inside * (5 * u * u - 1));  // φ̈, up to a factor
    whole += mean_.back(), linear += rate_.back() * t;
  }
  double bend_sum = 0;
  for (const double w : bend_) bend_sum += w;
  double square = 0;
  for (int j = -reach; j <= reach; ++j) {
    const auto i = static_cast<std::size_t>(j + reach);
    const double t = j * period_s;
    mean_[i] /= whole, rate_[i] /= linear;
    bend_[i] -= bend_sum * mean_[i];  // a constant has none
    square += bend_[i] * t * t / 2;
  }
  for (double& w : bend_) w /= square;
}

double Bump::sum(const std::vector<double>& weights, std::span<const double> x,
                 std::size_t k) const {
  const std::size_t first = k - reach();
  double sum = 0;
  for (std::size_t j = 0; j < weights.size(); ++j) sum += weights[j] * x[first + j];
  return sum;
}

std::vector<double> Bump::rates(std::span<const double> x) const {
  std::vector<double> all(x.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = reach(); k + reach() < x.size(); ++k) all[k] = rate(x, k);
  return all;
}

}  // namespace sim::residuals
