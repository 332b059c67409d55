#include "sim/gap/estimation/profile_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sim::estimation {
namespace {

/// The distance d from the estimate of unknown k towards `bound` at which the cost, −2 log
/// likelihood, has risen by the 95 % quantile of χ² with one degree of freedom.
double half_interval(const ResidualVector& residuals, const Unknowns& at, const Estimate& e,
                     std::size_t k, double bound) {
  constexpr double rise = 3.84;  // 95 % quantile
  constexpr int halvings = 12;
  const residuals::Stages stages(at.robot());
  const double minimum = e.weight.dot(e.z.cwiseAbs2());
  const auto costs_more = [&](double value) {
    const erp::Robot robot = at.with(k, value).robot();
    const Eigen::VectorXd z =
        residuals.z(residuals.explain(robot, e.explained, at.reach(k, stages)));
    return e.weight.dot(z.cwiseAbs2()) > minimum + rise;
  };
  if (!costs_more(bound)) return std::abs(bound - at.value(k));
  double within = at.value(k), beyond = bound;
  for (int n = 0; n < halvings; ++n) {
    const double middle = (within + beyond) / 2;
    (costs_more(middle) ? beyond : within) = middle;
  }
  return std::abs(beyond - at.value(k));
}

}  // namespace

void set_profile_variances(const ResidualVector& residuals, const Unknowns& at, Estimate& e) {
  constexpr double beyond_bounds = std::numeric_limits<double>::max();
  constexpr double half_interval_sigmas = 1.96;  // of 95 %
  for (std::size_t k = at.constants(); k < at.count(); ++k) {
    if (at.is_logarithm(k)) continue;
    const double low = at.with(k, -beyond_bounds).value(k),
                 high = at.with(k, beyond_bounds).value(k);
    if (e.sigma(k) < high - low) continue;
    const double larger_distance =
        std::max(half_interval(residuals, at, e, k, low), half_interval(residuals, at, e, k, high));
    const auto n = Eigen::Index(k);
    e.covariance.row(n).setZero(), e.covariance.col(n).setZero();
    e.covariance(n, n) = std::pow(larger_distance / half_interval_sigmas, 2);
  }
}

}  // namespace sim::estimation
