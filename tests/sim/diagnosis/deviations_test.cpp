#include "sim/diagnosis/deviations.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using sim::diagnosis::deviations;

namespace {

/// A slope fitted to z = slope·j + disturbance, many times.
struct Fitted {
  double spread = 0, said = 0;  ///< rms error of the slope; rms of its standard deviation
};

/// The disturbance is a first-order process of deviation `size` times |j|^`grows`, alike for `windows`.
Fitted fitted(double size, double windows, double grows) {
  constexpr int draws = 400, count = 2000;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  Eigen::VectorXd j(count);
  for (int k = 0; k < count; ++k) j[k] = 1.1 + std::sin(0.003 * k);
  const double keeps = std::exp(-1 / windows);
  Fitted f;
  for (int draw = 0; draw < draws; ++draw) {
    Eigen::VectorXd z(count);
    double state = normal(random);
    for (int k = 0; k < count; ++k) {
      z[k] = size * state * std::pow(j[k], grows);
      state = keeps * state + std::sqrt(1 - keeps * keeps) * normal(random);
    }
    const double slope = j.dot(z) / j.squaredNorm();
    f.spread += slope * slope / draws;
    f.said += std::pow(deviations(j, z - slope * j)[0], 2) / draws;
  }
  return {std::sqrt(f.spread), std::sqrt(f.said)};
}

}  // namespace

TEST_CASE("a value's deviation is that of repeated fits: white noise") {
  const Fitted f = fitted(1, 0.01, 0);
  CHECK(f.said == Approx(f.spread).epsilon(0.15));
}

TEST_CASE("a value's deviation is that of repeated fits: a disturbance alike for some windows") {
  const Fitted f = fitted(10, 5, 0);
  CHECK(f.said == Approx(f.spread).epsilon(0.15));
}

TEST_CASE(
    "a value's deviation is that of repeated fits: a disturbance that is larger where it tells "
    "more") {
  const Fitted f = fitted(10, 5, 2);
  CHECK(f.said == Approx(f.spread).epsilon(0.15));
}

TEST_CASE("a value is undetermined that changes nothing, or nothing that another does not") {
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(200, 4);
  for (int k = 0; k < 200; ++k) j(k, 0) = std::sin(0.1 * k), j(k, 1) = std::cos(0.1 * k);
  j.col(2) = 3 * j.col(1);
  const auto sigma = deviations(j, Eigen::VectorXd::Ones(200));
  CHECK(std::isfinite(sigma[0]));
  for (const std::size_t k : {1, 2, 3}) CHECK(std::isinf(sigma[k]));
}
