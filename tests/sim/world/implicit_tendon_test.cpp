#include "sim/world/implicit_tendon.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "sim/world/world.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim;

namespace {

/// A mass on a tendon that is always taut: x⁺⁺ = −κ x / m, about a stretch of `rest_m`.
struct Oscillator {
  double mass_kg, stiffness_N_per_m, damping_N_s_per_m = 0;
  double stretch_m = 0.02, speed_m_per_s = 0;
  static constexpr double rest_m = 0.01;

  double force_N() const { return stiffness_N_per_m * rest_m; }
  /// `theta` 0: chosen at each step.
  void step(double dt_s, double theta = 0) {
    const StretchedTendon tendon{stiffness_N_per_m, damping_N_s_per_m,
                                 stretch_m,         stiffness_N_per_m * stretch_m,
                                 speed_m_per_s,     0};
    Implicitness implicitness{theta, theta};
    if (theta == 0) implicitness = implicitness_of(tendon, 1 / mass_kg, dt_s);
    OneSidedForce force{0, 0, {{0, 1}}};
    pull_implicitly(tendon, implicitness, dt_s, force);
    const Eigen::MatrixXd h = Eigen::MatrixXd::Constant(1, 1, mass_kg);
    Eigen::VectorXd v = Eigen::VectorXd::Zero(1);
    StepSolver solver(1, 1, {});
    solver.begin(h, {&force, 1}, dt_s);
    solver.solve(Eigen::VectorXd::Constant(1, mass_kg * speed_m_per_s + dt_s * force_N()), v);
    speed_m_per_s = v[0];
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
  const double period_s = 2 * std::numbers::pi * std::sqrt(1 / 1000.0);
  const double before_m = mass.amplitude_m();
  for (int i = 0; i < 10000; ++i) mass.step(period_s / 200);  // 50 periods
  CHECK(mass.amplitude_m() == Approx(before_m).epsilon(0.02));
  CHECK(mass.stretch_m == Approx(0.02).epsilon(0.02));
}

TEST_CASE("with a coarse step θ = 1 dissipates energy and θ = ½ conserves it") {
  Oscillator dissipating{1, 1e4}, conserving{1, 1e4};
  double smallest_m = 1;
  for (int i = 0; i < 2000; ++i) {
    dissipating.step(0.01, 1), conserving.step(0.01, 0.5);
    if (i > 1900) smallest_m = std::min(smallest_m, conserving.amplitude_m());
  }
  CHECK(dissipating.amplitude_m() < 1e-6);
  CHECK(smallest_m > 0.002);
}

TEST_CASE("a damped oscillation matches the exact solution to second order in the step") {
  const double kappa = 6000, damping = 20, mass_kg = 0.4;
  const double decay = damping / (2 * mass_kg);
  const double omega = std::sqrt(kappa / mass_kg - decay * decay);
  double error[2];
  for (const int is_fine : {0, 1}) {
    const double dt_s = is_fine ? 5e-5 : 1e-4;
    Oscillator mass{mass_kg, kappa, damping, Oscillator::rest_m + 1e-3, 0};
    int steps = 0;
    double before_m = mass.stretch_m, first_s = 0;
    for (int crossings = 0; crossings < 6; ++steps) {
      before_m = mass.stretch_m - Oscillator::rest_m;
      mass.step(dt_s);
      const double now_m = mass.stretch_m - Oscillator::rest_m;
      if (before_m * now_m >= 0) continue;
      const double at_s = dt_s * (steps + before_m / (before_m - now_m));
      if (++crossings > 1)
        error[is_fine] = std::abs(5 * std::numbers::pi / omega - (at_s - first_s));
      else first_s = at_s;
    }
    CHECK(error[is_fine] < 1e-4 * 5 * std::numbers::pi / omega);
  }
  CHECK(error[1] < error[0] / 3);
}

TEST_CASE("a tendon with a damping of 1e6 N s/m is stable") {
  Oscillator mass{0.1, 1e5, 1e6};
  for (int i = 0; i < 1000; ++i) mass.step(1e-3);
  CHECK(std::abs(mass.stretch_m) < 0.03);
}

TEST_CASE("a slack tendon has tension 0 until it is taut") {
  OneSidedForce force{0, 0, {{0, 1}}};
  pull_implicitly({1000, 10, -0.002, -2, 1, 0}, {0.5, 0.5}, 1e-3, force);
  CHECK((force.row.empty() && force.start_N == 0));
  force.row = {{0, 1}};
  pull_implicitly({1000, 10, -0.0005, -0.5, 1, 0}, {0.5, 0.5}, 1e-3, force);
  CHECK(force.row.size() == 1);
}

TEST_CASE("tendons of 1e7 N/m are stable at 1 ms for a minute of motion") {
  for (const char* name : {"hinge_rig/robot.xml", "arm/robot.xml"}) {
    INFO(name);
    erp::Robot robot = erp::read_robot(rigs::config(name));
    for (auto& actuator : robot.actuators)
      actuator.tendon.stiffness_N_per_m = 1e7, actuator.tendon.damping_N_s_per_m = 0;
    for (auto& joint : robot.skeletons[0].joints) joint.viscous_Nm_s_per_rad = joint.coulomb_Nm = 0;
    World world(robot);
    std::vector<double> voltage_V(robot.actuators.size(), 0.0);
    double highest_speed = 0, highest_tension_N = 0;
    for (int i = 0; i < 60000; ++i) {
      for (std::size_t k = 0; k < voltage_V.size(); ++k)
        voltage_V[k] = std::max(0.0, std::sin(1e-3 * i + 2.0 * static_cast<double>(k))) - 0.2;
      world.step(voltage_V, 1e-3);
      for (const auto& joint : world.joints())
        for (const double v : joint.velocity_rad_per_s)
          highest_speed = std::max(highest_speed, std::abs(v));
      for (const auto& a : world.actuators())
        highest_tension_N = std::max(highest_tension_N, a.tension_N);
    }
    CAPTURE(highest_speed, highest_tension_N);
    CHECK(highest_speed < 3);
    CHECK(highest_tension_N < 1500);
  }
}
