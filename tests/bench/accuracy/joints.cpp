#include <cmath>
#include <numbers>
#include <tuple>

#include "sim/world/world.hpp"
#include "tests/bench/accuracy/figure.hpp"
#include "tests/bench/accuracy/period.hpp"
#include "tests/sim/skeletons.hpp"

namespace accuracy {
namespace {

using sim::Vec3, sim::World;

constexpr double dt_s = 1e-4, g = 9.81;

double angle(const World& world) { return world.joints()[0].position[0]; }
double speed(const World& world) { return world.joints()[0].velocity_rad_per_s[0]; }

// θ'' = −(m g l / I) sin θ:  T = 4 √(I / m g l) K(sin θ₀/2), K = π / 2 AGM(1, cos θ₀/2)
double exact_period_s(double amplitude) {
  double a = 1, b = std::cos(amplitude / 2);
  for (int k = 0; k < 20; ++k) std::tie(a, b) = std::pair((a + b) / 2, std::sqrt(a * b));
  const double torque_Nm = rigs::pendulum_mass_kg * g * rigs::pendulum_l_m;
  return 4 * std::sqrt(rigs::pendulum_I_kg_m2 / torque_Nm) * std::numbers::pi / (2 * a);
}

double period_error() {
  const double amplitude = 1.2;  // chosen
  World world(rigs::pendulum(amplitude));
  const double measured_period_s = mean_period_s(world, 10, dt_s, [&] { return angle(world); });
  return relative_error(measured_period_s, exact_period_s(amplitude));
}

/// Steps the world until the joint reverses its direction. Returns its angle at this time.
double next_reversal(World& world) {
  for (double speed_before = speed(world);; speed_before = speed(world)) {
    world.step({}, dt_s);
    if (speed_before * speed(world) < 0) return angle(world);
  }
}

// |θ_k| − |θ_k+1| = 2 τ_c / (m g l), sin θ ≈ θ
double coulomb_error() {
  const double coulomb_Nm = 0.004, start_rad = 0.15;  // chosen
  World world(rigs::pendulum(start_rad, 0, coulomb_Nm));
  const double exact = 2 * coulomb_Nm / (rigs::pendulum_mass_kg * g * rigs::pendulum_l_m);
  double worst = 0, last_angle = start_rad;
  for (int k = 0; k < 6; ++k) {
    const double reversal_angle = std::abs(next_reversal(world));
    worst = larger(worst, relative_error(last_angle - reversal_angle, exact));
    last_angle = reversal_angle;
  }
  return worst;
}

Vec3 vector_of(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

/// Largest relative drift in 5 s.
struct Drift {
  double energy = 0, momentum = 0;
};

// ½ ω·I ω and R I ω are constant
Drift ball_drift() {
  const erp::Robot robot = rigs::ball();
  const Vec3 inertia_kg_m2 = vector_of(robot.skeletons[0].bodies[1].inertia_kg_m2);
  World world(robot);
  world.set_joint(0, {erp::JointType::spherical, {1, 0, 0, 0}, {3, 1, 2}, {}, {}});  // chosen
  const auto momentum = [&]() -> Vec3 {
    return world.poses()[1].rotation *
           inertia_kg_m2.cwiseProduct(vector_of(world.joints()[0].velocity_rad_per_s));
  };
  const double energy_J = world.energy_J();
  const Vec3 start_momentum = momentum();
  Drift worst;
  for (int k = 0; k < 50000; ++k) {
    world.step({}, dt_s);
    worst.energy = larger(worst.energy, relative_error(world.energy_J(), energy_J));
    worst.momentum =
        larger(worst.momentum, (momentum() - start_momentum).norm() / start_momentum.norm());
  }
  return worst;
}

/// The skeleton of configs/arm without muscles.
erp::Robot bare_arm() {
  erp::Robot arm = erp::read_robot(rigs::config("arm/robot.xml"));
  arm.actuators.clear();
  for (auto& joint : arm.skeletons[0].joints) {
    joint.viscous_Nm_s_per_rad = joint.coulomb_Nm = 0;
    joint.min_rad = -1000, joint.max_rad = 1000;
  }
  return arm;
}

// E(t) = E(0)
double arm_drift_J(double step_s) {
  World world(bare_arm(), {.usual_step_s = step_s});
  world.set_joint(0, {erp::JointType::spherical, {0.8, 0.6, 0, 0}, {}, {}, {}});  // chosen
  const double start_J = world.energy_J();
  double worst_J = 0;
  for (int k = 0; k < std::lround(10 / step_s); ++k) {
    world.step({}, step_s);
    worst_J = larger(worst_J, std::abs(world.energy_J() - start_J));
  }
  return worst_J;
}

}  // namespace

Figures pendulum() {
  const Drift ball = ball_drift();
  return {
      {6, "period of a pendulum with an amplitude of 1.2 rad, relative", period_error(), 1e-5, ""},
      {6, "amplitude loss by Coulomb friction per half oscillation, relative", coulomb_error(),
       0.02, ""},
      {6, "drift of a free ball joint's energy in 5 s, relative", ball.energy, 5e-3, ""},
      {6, "drift of its angular momentum, relative", ball.momentum, 5e-3, ""}};
}

Figures free_arm() {
  return {{7, "drift of the free arm's energy in 10 s at 1 ms", arm_drift_J(1e-3), 0.1, "J"},
          {7, "drift of the free arm's energy in 10 s at 0.1 ms", arm_drift_J(1e-4), 0.01, "J"}};
}

}  // namespace accuracy
