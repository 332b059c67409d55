#include "sim/gap/diagnosis/standard_errors.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using sim::diagnosis::standard_errors;

namespace {

/// Results of many fits of a slope to z = slope·j + disturbance.
struct Fitted {
  double spread = 0, error = 0;  ///< rms error of the slope; rms of its standard error
};

/// Fits with a disturbance: a first-order autoregressive process with the standard deviation `size`
/// · |j|^`exponent` and the correlation time `windows`.
Fitted fitted(double size, double windows, double exponent) {
  constexpr int draws = 400, count = 2000;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  Eigen::VectorXd j(count);
  for (int k = 0; k < count; ++k) j[k] = 1.1 + std::sin(0.003 * k);
  const double correlation = std::exp(-1 / windows);
  Fitted f;
  for (int draw = 0; draw < draws; ++draw) {
    Eigen::VectorXd z(count);
    double state = normal(random);
    for (int k = 0; k < count; ++k) {
      z[k] = size * state * std::pow(j[k], exponent);
      state = correlation * state + std::sqrt(1 - correlation * correlation) * normal(random);
    }
    const double slope = j.dot(z) / j.squaredNorm();
    f.spread += slope * slope / draws;
    f.error += std::pow(standard_errors(j, z - slope * j)[0], 2) / draws;
  }
  return {std::sqrt(f.spread), std::sqrt(f.error)};
}

}  // namespace

TEST_CASE("the standard error of a slope equals the spread of 400 fits with white noise") {
  const Fitted f = fitted(1, 0.01, 0);
  CHECK(f.error == Approx(f.spread).epsilon(0.15));
}

TEST_CASE(
    "the standard error of a slope equals the spread of 400 fits with a disturbance that is "
    "correlated over 5 windows") {
  const Fitted f = fitted(10, 5, 0);
  CHECK(f.error == Approx(f.spread).epsilon(0.15));
}

TEST_CASE(
    "the standard error of a slope equals the spread of 400 fits with a disturbance that is larger "
    "at "
    "high sensitivity") {
  const Fitted f = fitted(10, 5, 2);
  CHECK(f.error == Approx(f.spread).epsilon(0.15));
}

TEST_CASE(
    "the standard error is infinite for a parameter without sensitivity and for two collinear "
    "parameters") {
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(200, 4);
  for (int k = 0; k < 200; ++k) j(k, 0) = std::sin(0.1 * k), j(k, 1) = std::cos(0.1 * k);
  j.col(2) = 3 * j.col(1);
  const auto sigma = standard_errors(j, Eigen::VectorXd::Ones(200));
  CHECK(std::isfinite(sigma[0]));
  for (const std::size_t k : {1, 2, 3}) CHECK(std::isinf(sigma[k]));
}
