#include "sim/world/step_solver.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <random>

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using sim::JointFriction, sim::OneSidedForce, sim::StepSolver;

namespace {

constexpr double dt = 1e-3;

/// H of a ball joint and a hinge, coupled as in an arm.
MatrixXd coupled() {
  MatrixXd h(4, 4);
  h << 0.09, 0.01, 0.00, 0.02, 0.01, 0.08, 0.005, 0.03, 0.00, 0.005, 0.01, 0.001, 0.02, 0.03, 0.001,
      0.04;
  return h;
}

VectorXd four(double a, double b, double c, double d) {
  VectorXd v(4);
  v << a, b, c, d;
  return v;
}

const std::vector<JointFriction> frictions{{0, 3, 0.1, 0.05}, {3, 1, 0.05, 0.03}};

VectorXd solve(const MatrixXd& h, const std::vector<OneSidedForce>& forces,
               const std::vector<JointFriction>& joints, const VectorXd& p,
               std::vector<double>* tensions_N = nullptr) {
  const auto n = static_cast<int>(p.size());
  StepSolver solver(n, static_cast<int>(forces.size()), joints);
  VectorXd v = VectorXd::Zero(n);
  solver.begin(h, forces, dt);
  REQUIRE(solver.solve(p, v));
  if (tensions_N) tensions_N->assign(solver.forces_N().begin(), solver.forces_N().end());
  return v;
}

/// Error of the momentum balance at v, in N s, beyond the admissible friction.
double unbalanced(const MatrixXd& h, const std::vector<OneSidedForce>& forces,
                  const std::vector<JointFriction>& joints, const VectorXd& p, const VectorXd& v) {
  VectorXd residual = h * v - p;
  for (const auto& force : forces)
    for (const auto& term : force.row)
      residual[term.coordinate] +=
          dt * term.slope * std::max(0.0, force.start_N + force.gain_N_s_per_m * force.along(v));
  for (const auto& j : joints) {
    auto joint_residual = residual.segment(j.first, j.dofs);
    const VectorXd speed = v.segment(j.first, j.dofs);
    joint_residual += dt * j.viscous_Nm_s_per_rad * speed;
    if (speed.norm() > 0) joint_residual += dt * j.coulomb_Nm * speed.normalized();
    else
      joint_residual *=
          std::max(0.0, 1 - dt * j.coulomb_Nm / std::max(1e-300, joint_residual.norm()));
  }
  return residual.lpNorm<Eigen::Infinity>();
}

}  // namespace

TEST_CASE("each friction impulse satisfies its law at the final velocity") {
  const VectorXd p = coupled() * four(1, -2, 0.5, 3);
  const VectorXd v = solve(coupled(), {}, frictions, p);
  const VectorXd impulse = coupled() * v - p;
  const Vector3d ball = v.head<3>();
  CHECK((impulse.head<3>() + dt * (0.1 * ball + 0.05 * ball.normalized())).norm() < 1e-13);
  CHECK(impulse[3] == Approx(-dt * (0.05 * v[3] + 0.03)).epsilon(1e-9));
}

TEST_CASE("slow joints stop exactly") {
  CHECK(solve(coupled(), {}, frictions, four(2e-5, -2e-5, 1e-5, 2e-5)).norm() == 0.0);
}

TEST_CASE("a joint can stick while its neighbour slides") {
  const VectorXd v = solve(coupled(), {}, frictions, four(0, 0, 0, 8e-5));
  CHECK(v.head<3>().norm() == 0.0);
  CHECK(v[3] > 1e-4);
}

TEST_CASE("a one-sided force of the wrong sign is zero and the other one takes the whole load") {
  // Antagonists on one coordinate.
  const std::vector<OneSidedForce> pair{{1, 5, {{0, 1}}}, {1e-6, 5, {{0, -1}}}};
  std::vector<double> f;
  const MatrixXd h = MatrixXd::Identity(1, 1);
  solve(h, pair, {}, VectorXd::Constant(1, -10.0), &f);
  CHECK(f[0] == 0);
  CHECK(f[1] == Approx(1e-6 + 5 * 10).epsilon(0.01));
  solve(h, pair, {}, VectorXd::Constant(1, 10.0), &f);
  CHECK(f[0] > 50);
  CHECK(f[1] == 0);
}

TEST_CASE("a stop removes all but 1e-7 of the excess speed") {
  const double allowed = 1, gain = 1e7 * 0.04 / dt;
  const std::vector<OneSidedForce> stop{{-gain * allowed, gain, {{3, 1}}}};
  CHECK(solve(coupled(), stop, {}, coupled() * four(0, 0, 0, 5))[3] == Approx(1).epsilon(1e-6));
  CHECK(solve(coupled(), stop, {}, coupled() * four(0, 0, 0, 0.5))[3] == Approx(0.5));
}

TEST_CASE("momentum is balanced in every step") {
  std::mt19937 random(7);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int trial = 0; trial < 500; ++trial) {
    const int n = 3 + trial % 40;
    const MatrixXd root = MatrixXd::NullaryExpr(n, n, [&] { return draw(-1, 1); });
    const MatrixXd h = 0.01 * root * root.transpose() + 1e-4 * MatrixXd::Identity(n, n);
    std::vector<JointFriction> joints;
    for (int first = 0; first < n; first += joints.back().dofs)
      joints.push_back(
          {first, first % 2 || n - first < 3 ? 1 : 3, draw(0, 0.1), trial % 5 ? draw(0, 0.5) : 0});
    std::vector<OneSidedForce> forces;
    for (int k = 0; k < 9; ++k) {
      forces.push_back({draw(-50, 50), std::pow(10, draw(0, 5)), {}});
      for (int d = k; d < n; d += 3) forces.back().row.push_back({d, draw(-0.05, 0.05)});
    }
    const VectorXd p =
        std::pow(10, draw(-4, 0)) * VectorXd::NullaryExpr(n, [&] { return draw(-1, 1); });
    const VectorXd v = solve(h, forces, joints, p);
    CAPTURE(trial, p.norm(), v.transpose());
    CHECK(unbalanced(h, forces, joints, p, v) < 1e-10 * (1 + p.norm()));
  }
}

TEST_CASE("a second load in the same posture is solved correctly") {
  StepSolver solver(4, 0, frictions);
  const MatrixXd h = coupled();
  solver.begin(h, {}, dt);
  VectorXd v = VectorXd::Zero(4);
  for (const double size : {1.0, 1.001, 1e-5, 0.3}) {
    const VectorXd p = size * (h * four(1, -2, 0.5, 3));
    REQUIRE(solver.solve(p, v));
    CHECK((v - solve(h, {}, frictions, p)).norm() < 1e-10);
  }
}
