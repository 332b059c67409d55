#include "sim/control/box_qp.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <random>

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Problem {
  MatrixXd h;
  VectorXd c, low, high;
};

/// A random problem with condition number up to 10^`decades`; a quarter of the bounds are
/// equalities.
Problem random_problem(std::mt19937& random, int n, double decades) {
  std::normal_distribution<double> normal;
  const auto draw = [&] { return normal(random); };
  const MatrixXd a = MatrixXd::NullaryExpr(n, n, draw);
  VectorXd scale = VectorXd::NullaryExpr(n, draw);
  scale = (scale.array() * decades / 4).unaryExpr([](double x) { return std::pow(10, x); });
  Problem p{scale.asDiagonal() * (a * a.transpose()) * scale.asDiagonal(),
            VectorXd::NullaryExpr(n, draw),
            VectorXd::NullaryExpr(n, draw),
            {}};
  p.h.diagonal().array() += 1e-3;
  p.c = scale.cwiseProduct(p.c) * n;
  p.high = p.low + VectorXd::NullaryExpr(n, draw).cwiseMax(0);
  return p;
}

/// Karush–Kuhn–Tucker conditions: x is within the bounds; the gradient is zero for free variables,
/// ≥ 0 at lower and ≤ 0 at upper bounds.
void check_optimality(const Problem& p, const VectorXd& x) {
  const VectorXd gradient = p.h * x - p.c;
  const double tolerance = 1e-7 * (p.h.cwiseAbs() * x.cwiseAbs() + p.c.cwiseAbs()).maxCoeff();
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    INFO("variable " << k << " at " << x[k] << " in " << p.low[k] << " … " << p.high[k]);
    REQUIRE(x[k] >= p.low[k]);
    REQUIRE(x[k] <= p.high[k]);
    if (x[k] > p.low[k]) REQUIRE(gradient[k] < tolerance);
    if (x[k] < p.high[k]) REQUIRE(gradient[k] > -tolerance);
  }
}

}  // namespace

TEST_CASE("with one of two variables at its bound, the other is the constrained minimum") {
  // min ½ (2 x² + 2 x y + 2 y²) − 4 x − 2 y,  x ≤ 1: at the bound y = (2 − x) / 2
  sim::BoxQp qp(2);
  const MatrixXd h = (MatrixXd(2, 2) << 2, 1, 1, 2).finished();
  const VectorXd x =
      qp.solve(h, Eigen::Vector2d(4, 2), Eigen::Vector2d(-9, -9), Eigen::Vector2d(1, 9));
  CHECK(x[0] == 1);
  CHECK(x[1] == Approx(0.5));
  CHECK(qp.multipliers()[0] == Approx(-1.5));  // 2·1 + 0.5 − 4
  CHECK(qp.multipliers()[1] == Approx(0).margin(1e-15));
}

TEST_CASE("without active bounds the result solves the linear system H x = c") {
  std::mt19937 random(1);
  Problem p = random_problem(random, 20, 2);
  p.low.setConstant(-1e9), p.high.setConstant(1e9);
  sim::BoxQp qp(20);
  CHECK((qp.solve(p.h, p.c, p.low, p.high) - p.h.llt().solve(p.c)).norm() < 1e-9 * p.c.norm());
  CHECK(qp.changes() == 0);
}

TEST_CASE("the result satisfies the KKT conditions for any size, from a cold or a warm start") {
  std::mt19937 random(2);
  for (const int n : {1, 2, 5, 11, 54}) {
    sim::BoxQp qp(n);
    for (int k = 0; k < 60; ++k) {
      const Problem p = random_problem(random, n, k % 4);
      if (k % 3 == 0) qp.start_cold();
      const VectorXd x = qp.solve(p.h, p.c, p.low, p.high);
      CHECK(qp.converged());
      check_optimality(p, x);
    }
  }
}

TEST_CASE("near the last solution few bounds change, and the result equals that of a cold start") {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Problem p = random_problem(random, 54, 1);
  sim::BoxQp warm(54), cold(54);
  warm.solve(p.h, p.c, p.low, p.high);
  int warm_changes = 0, cold_changes = 0;
  for (int k = 0; k < 50; ++k) {
    p.c += 0.003 * p.c.norm() / 7 * VectorXd::NullaryExpr(54, [&] { return normal(random); });
    cold.start_cold();
    const VectorXd x = warm.solve(p.h, p.c, p.low, p.high);
    CHECK((cold.solve(p.h, p.c, p.low, p.high) - x).norm() < 1e-8 * (1 + x.norm()));
    warm_changes += warm.changes(), cold_changes += cold.changes();
  }
  CHECK(warm_changes < cold_changes / 5);
}

TEST_CASE("contradictory bounds and an indefinite H are rejected") {
  sim::BoxQp qp(2);
  const MatrixXd one = MatrixXd::Identity(2, 2);
  const VectorXd zero = VectorXd::Zero(2), up = VectorXd::Ones(2);
  CHECK_THROWS_AS(qp.solve(one, zero, up, zero), std::invalid_argument);
  CHECK_THROWS_AS(qp.solve(-one, zero, zero, up), std::invalid_argument);
}
