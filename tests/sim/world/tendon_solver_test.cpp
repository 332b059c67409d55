#include "sim/world/tendon_solver.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "sim/world/world.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim;

namespace {

/// A mass on a tendon that always pulls: x⁺⁺ = −κ x / m, about a stretch of `rest_m`.
struct Oscillator {
  double mass_kg, stiffness_N_per_m, damping_N_s_per_m = 0;
  double stretch_m = 0.02, speed_m_per_s = 0;
  static constexpr double rest_m = 0.01;

  double force_N() const { return stiffness_N_per_m * rest_m; }
  void step(TendonSolver& solver, double dt_s) {
    const Eigen::MatrixXd h = Eigen::MatrixXd::Constant(1, 1, mass_kg);
    const Eigen::MatrixXd row = Eigen::MatrixXd::Ones(1, 1);
    const Eigen::VectorXd momentum =
        Eigen::VectorXd::Constant(1, mass_kg * speed_m_per_s + dt_s * force_N());
    const StretchedTendon tendon{stiffness_N_per_m, damping_N_s_per_m, stretch_m, speed_m_per_s, 0};
    const double f = solver.solve(h, row, momentum, {&tendon, 1}, dt_s)[0];
    speed_m_per_s += dt_s * (force_N() - f) / mass_kg;
    stretch_m += dt_s * speed_m_per_s;
  }
  double amplitude_m() const {
    const double x = stretch_m - rest_m;
    return std::sqrt(x * x + mass_kg / stiffness_N_per_m * speed_m_per_s * speed_m_per_s);
  }
};

}  // namespace

TEST_CASE("a resolved oscillation keeps its amplitude and its period") {
  Oscillator mass{1, 1000};
  TendonSolver solver(1, 1);
  const double period_s = 2 * std::numbers::pi * std::sqrt(1 / 1000.0);
  const double before_m = mass.amplitude_m();
  for (int i = 0; i < 10000; ++i) mass.step(solver, period_s / 200);  // 50 periods
  CHECK(mass.amplitude_m() == Approx(before_m).epsilon(0.02));
  CHECK(mass.stretch_m == Approx(0.02).epsilon(0.02));
}

TEST_CASE("backward Euler drains, one half keeps, at a step that resolves little") {
  Oscillator drained{1, 1e4}, kept{1, 1e4};
  TendonSolver euler(1, 1, 1), half(1, 1, 0.5);
  double least_m = 1;
  for (int i = 0; i < 2000; ++i) {
    drained.step(euler, 0.01), kept.step(half, 0.01);
    if (i > 1900) least_m = std::min(least_m, kept.amplitude_m());
  }
  CHECK(drained.amplitude_m() < 1e-6);
  CHECK(least_m > 0.002);
}

TEST_CASE("damping of any size is stable") {
  Oscillator mass{0.1, 1e5, 1e6};
  TendonSolver solver(1, 1);
  for (int i = 0; i < 1000; ++i) mass.step(solver, 1e-3);
  CHECK(std::abs(mass.stretch_m) < 0.03);
}

TEST_CASE("a tendon that would push is left out, the other carries all") {
  // Two antagonists on one coordinate; the second is driven slack.
  const Eigen::MatrixXd h = Eigen::MatrixXd::Identity(1, 1);
  Eigen::MatrixXd rows(2, 1);
  rows << 1, -1;
  const StretchedTendon tendons[] = {{1000, 0, 0.01, 0, 0}, {1000, 0, 1e-9, 0, 0}};
  TendonSolver solver(2, 1);
  const auto f = solver.solve(h, rows, Eigen::VectorXd::Constant(1, -10.0), tendons, 1e-3);
  CHECK(f[0] < 1e-9 + 1000 * 0.01);
  CHECK(f[1] > 0);  // it is drawn out
  const auto g = solver.solve(h, rows, Eigen::VectorXd::Constant(1, 10.0), tendons, 1e-3);
  CHECK(g[0] > 10);
  CHECK(g[1] == 0);
}

TEST_CASE("tendons of 1e7 N/m are stable at 1 ms for a minute of being driven") {
  for (const char* name : {"hinge_rig/robot.xml", "arm/robot.xml"}) {
    INFO(name);
    erp::Robot robot = erp::read_robot(rigs::config(name));
    for (auto& actuator : robot.actuators)
      actuator.tendon.stiffness_N_per_m = 1e7, actuator.tendon.damping_N_s_per_m = 0;
    for (auto& joint : robot.skeletons[0].joints) joint.viscous_Nm_s_per_rad = joint.coulomb_Nm = 0;
    World world(robot);
    std::vector<double> voltage_V(robot.actuators.size(), 0.0);
    double fastest = 0, strongest_N = 0;
    for (int i = 0; i < 60000; ++i) {
      for (std::size_t k = 0; k < voltage_V.size(); ++k)
        voltage_V[k] = std::max(0.0, std::sin(1e-3 * i + 2.0 * static_cast<double>(k))) - 0.2;
      world.step(voltage_V, 1e-3);
      for (const auto& joint : world.joints())
        for (const double v : joint.velocity_rad_per_s) fastest = std::max(fastest, std::abs(v));
      for (const auto& a : world.actuators()) strongest_N = std::max(strongest_N, a.tension_N);
    }
    CAPTURE(fastest, strongest_N);
    CHECK(fastest < 3);
    CHECK(strongest_N < 1500);
  }
}
