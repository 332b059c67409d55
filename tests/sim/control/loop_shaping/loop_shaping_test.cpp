#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "sim/control/loop_shaping/joint_loops.hpp"
#include "sim/control/loop_shaping/riccati.hpp"

using namespace sim::loop_shaping;
using Eigen::MatrixXd;

namespace {

MatrixXd scalar(double value) { return MatrixXd::Constant(1, 1, value); }

MatrixXd random_matrix(std::mt19937& random, int rows, int columns) {
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

/// 1/s²
StateSpace double_integrator() { return in_series(first_order(0, 1, 0), first_order(0, 1, 0)); }

sim::Musculoskeletal model_of(const std::string& name) {
  return sim::Musculoskeletal(erp::read_robot(ERP_SOURCE_DIR "/configs/" + name + "/robot.xml"));
}

}  // namespace

TEST_CASE("the Riccati equation of one state has the closed-form solution") {
  // 2 a x − g x² + q = 0, the root at which a − g x < 0
  for (const double a : {-3.0, 0.0, 2.0}) {
    const double g = 0.5, q = 4;
    CHECK(riccati(scalar(a), scalar(g), scalar(q))(0, 0) ==
          Approx((a + std::sqrt(a * a + g * q)) / g).epsilon(1e-12));
  }
}

TEST_CASE("solutions of random Riccati equations stabilise and have zero residual") {
  std::mt19937 random(1);
  for (const int n : {2, 7, 40}) {
    const MatrixXd a = random_matrix(random, n, n), b = random_matrix(random, n, n / 2 + 1),
                   c = random_matrix(random, n / 2 + 1, n);
    const MatrixXd g = b * b.transpose(), q = c.transpose() * c, x = riccati(a, g, q);
    CHECK((a.transpose() * x + x * a - x * g * x + q).norm() < 1e-8 * (1 + x.norm()));
    const auto poles = Eigen::EigenSolver<MatrixXd>(a - g * x, false).eigenvalues().real().eval();
    CHECK(poles.maxCoeff() < 0);
  }
}

TEST_CASE("an uncontrollable unstable mode is rejected with std::domain_error") {
  CHECK_THROWS_AS(riccati(scalar(1), scalar(0), scalar(1)), std::domain_error);
}

TEST_CASE("the largest margin of a double integrator is 1/sqrt(4 + 2 sqrt 2)") {
  const RobustLoop loop = stabilised(double_integrator());
  CHECK(loop.greatest_margin == Approx(1 / std::sqrt(4 + 2 * std::sqrt(2.0))).epsilon(1e-9));
  CHECK(loop.margin == Approx(loop.greatest_margin / 1.1));
}

TEST_CASE("the margin measured over frequency equals the margin of the design") {
  const StateSpace plant = double_integrator();
  const RobustLoop loop = stabilised(plant, 1.05);
  CHECK(slowest_pole_per_s(closed(plant, loop.controller)) < 0);
  const double measured = margin_of(plant, loop.controller, 1e-3, 1e3);
  CHECK(measured >= loop.margin * (1 - 1e-6));
  CHECK(measured <= loop.greatest_margin * (1 + 1e-6));
}

TEST_CASE(
    "for slow signals the response of a sampled system equals that of the continuous system") {
  const StateSpace lag = in_series(first_order(0, 5, 5), first_order(1, 2, 3));
  const double period_s = 0.002, w = 4;
  Sampled sampled(lag, period_s);
  double largest_error = 0;
  for (int k = 0; k < 5000; ++k) {
    const double y = sampled.step(Eigen::VectorXd::Constant(1, std::sin(w * k * period_s)))[0];
    const auto g = response(lag, w)(0, 0);
    const double expected = std::abs(g) * std::sin(w * k * period_s + std::arg(g));
    if (k > 3000) largest_error = std::max(largest_error, std::abs(y - expected));
  }
  CHECK(largest_error < 1e-4);
}

TEST_CASE("joint loops of robots have the designed crossover and a margin") {
  for (const std::string name : {"hinge_rig", "twin_joint", "seven_dof"}) {
    INFO(name);
    auto model = model_of(name);
    const JointShape shape;
    const JointLoops loops = joint_loops(model, shape);
    const LoopCheck check = checked(loops);
    CHECK(loops.robust.margin > 0.25);
    CHECK(check.slowest_per_s < 0);
    CHECK(check.margin == Approx(loops.robust.margin).epsilon(0.02));
    for (const double hz : check.crossover_Hz) {
      CHECK(hz > 0.3 * shape.crossover_Hz);  // K∞ and the other joints lower it
      CHECK(hz < 1.7 * shape.crossover_Hz);
    }
  }
}

TEST_CASE("a plant that differs strongly from the model has no margin") {
  auto model = model_of("twin_joint");
  JointLoops loops = joint_loops(model, {});
  loops.plant = hinge_plant(model, {.delay_s = 0.2});
  const LoopCheck check = checked(loops);
  CHECK(check.slowest_per_s > 0);
}

TEST_CASE("a robot with a ball joint is rejected") {
  auto model = model_of("arm");
  CHECK_THROWS_WITH(joint_loops(model, {}), Catch::Contains("is not a hinge"));
}
