#include "sim/learning/calibration/evolution.hpp"

#include <catch2/catch.hpp>

using namespace sim::calibration;

namespace {

/// Scales of 1 to 30, difficult for a strategy with one common step size.
double bowl(const Eigen::VectorXd& x) {
  double sum = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double scale = std::pow(30.0, double(i) / double(x.size() - 1));
    sum += std::pow(scale * (x[i] - 0.5), 2);
  }
  return std::sqrt(sum);
}

double error_after(Evolution& evolution, int generations) {
  for (int g = 0; g < generations; ++g) {
    auto all = evolution.offspring();
    for (auto& individual : all) individual.error = bowl(individual.x);
    evolution.select(std::move(all));
  }
  return evolution.parents().front().error;
}

}  // namespace

TEST_CASE("an evolution strategy minimises a badly scaled quadratic to 1 %") {
  const Eigen::VectorXd first = Eigen::VectorXd::Zero(10);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Evolution evolution(first, {.seed = seed});
    const double before = bowl(first);
    CHECK(error_after(evolution, 250) < 0.01 * before);
  }
}

TEST_CASE(
    "equal parents and seeds give equal generations, and another seed gives other generations") {
  const Eigen::VectorXd first = Eigen::VectorXd::Zero(4);
  Evolution uninterrupted(first, {.seed = 3}), other(first, {.seed = 4});
  error_after(uninterrupted, 10);
  Evolution resumed(uninterrupted.parents(), uninterrupted.generation(), {.seed = 3});
  error_after(uninterrupted, 10), error_after(resumed, 10), error_after(other, 20);
  CHECK(uninterrupted.parents().front().x == resumed.parents().front().x);
  CHECK(uninterrupted.parents().front().x != other.parents().front().x);
}

TEST_CASE("offspring stay within the bounds, and parents do not survive their generation") {
  Evolution evolution(Eigen::VectorXd::Constant(3, 0.9), {.first_sigma = 5, .bound = 1});
  auto all = evolution.offspring();
  REQUIRE(all.size() == 36);
  for (const auto& individual : all) CHECK(individual.x.cwiseAbs().maxCoeff() <= 1);
  for (std::size_t k = 0; k < all.size(); ++k) all[k].error = 100 + double(k);
  evolution.select(all);
  REQUIRE(evolution.parents().size() == 6);
  CHECK(evolution.parents()[5].error == 105);
}
