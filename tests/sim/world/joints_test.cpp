#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "sim/world/world.hpp"
#include "tests/sim/skeletons.hpp"

using namespace rigs;
using sim::JointReading, sim::Vec3, sim::World;

namespace {

double angle(const World& world) { return world.joints()[0].position[0]; }
double speed(const World& world) { return world.joints()[0].velocity_rad_per_s[0]; }

/// Runs until the speed changes sign. Returns the angle after the first step with the new sign.
double next_reversal(World& world, double dt) {
  double before = speed(world);
  while (true) {
    world.step({}, dt);
    const double now = speed(world);
    if (before * now < 0 || now == 0) return angle(world);
    before = now;
  }
}

JointReading spinning(const Vec3& velocity) {
  JointReading reading;
  reading.type = erp::JointType::spherical;
  reading.position = {1, 0, 0, 0};
  reading.velocity_rad_per_s = {velocity.x(), velocity.y(), velocity.z()};
  return reading;
}

Vec3 velocity(const World& world) {
  const auto& v = world.joints()[0].velocity_rad_per_s;
  return {v[0], v[1], v[2]};
}

/// K(sin θ/2), the complete elliptic integral, by the arithmetic-geometric mean.
double elliptic(double amplitude) {
  double a = 1, g = std::cos(amplitude / 2);
  for (int k = 0; k < 20; ++k) std::tie(a, g) = std::pair((a + g) / 2, std::sqrt(a * g));
  return std::numbers::pi / (2 * a);
}

}  // namespace

TEST_CASE("the period of a pendulum is given by the elliptic integral") {
  const double amplitude = 1.2, dt = 1e-4;
  World world(pendulum(amplitude));
  double last_crossing = 0, first_crossing = 0, before = angle(world);
  int crossings = 0;
  while (crossings < 11) {
    world.step({}, dt);
    const double now = angle(world);
    if (before > 0 && now <= 0) {
      last_crossing = world.time_s() - dt * now / (now - before);
      if (++crossings == 1) first_crossing = last_crossing;
    }
    before = now;
  }
  const double omega = std::sqrt(pendulum_mass_kg * 9.81 * pendulum_l_m / pendulum_I_kg_m2);
  CHECK((last_crossing - first_crossing) / 10 ==
        Approx(4 * elliptic(amplitude) / omega).epsilon(1e-5));
}

TEST_CASE("Coulomb friction reduces the amplitude by 2 τ_c / (m g l) each half swing") {
  const double torque = 0.004;
  World world(pendulum(0.15, 0, torque));
  const double step = 2 * torque / (pendulum_mass_kg * 9.81 * pendulum_l_m);
  double last = 0.15;
  for (int k = 0; k < 6; ++k) {
    const double reversal = std::abs(next_reversal(world, 1e-4));
    CHECK(last - reversal == Approx(step).epsilon(0.02));
    last = reversal;
  }
}

TEST_CASE("a joint sticks, without creeping, while the load is below its friction") {
  const double limit_rad = std::asin(0.1 / (pendulum_mass_kg * 9.81 * pendulum_l_m));
  World below(pendulum(limit_rad * 0.999, 0.01, 0.1)),
      above(pendulum(limit_rad * 1.001, 0.01, 0.1));
  for (int k = 0; k < 5000; ++k) below.step({}, 1e-3), above.step({}, 1e-3);
  CHECK(std::abs(angle(below) - limit_rad * 0.999) < 1e-12);
  CHECK(std::abs(angle(above) - limit_rad * 1.001) > 1e-6);
}

TEST_CASE("with viscous friction speed decays as exp(−µ t / I), stable for any µ") {
  const double mu = 0.05;
  erp::Robot free = pendulum(0, mu);
  free.skeletons[0].gravity_m_per_s2 = xml::Vec3{0, 0, 0};
  World world(free);
  JointReading reading = world.joints()[0];
  reading.velocity_rad_per_s[0] = 2;
  world.set_joint(0, reading);
  for (int k = 0; k < 10000; ++k) world.step({}, 1e-4);
  CHECK(speed(world) == Approx(2 * std::exp(-mu / pendulum_I_kg_m2)).epsilon(1e-3));

  free.skeletons[0].joints[0].viscous_Nm_s_per_rad = 1e6;
  World stiff(free);
  stiff.set_joint(0, reading);
  stiff.step({}, 1e-3);
  CHECK(std::abs(speed(stiff)) < 1e-3);
}

TEST_CASE("a free ball joint conserves energy and momentum") {
  World world(ball());
  world.set_joint(0, spinning({3, 1, 2}));
  const Vec3 inertia(0.02, 0.015, 0.01);
  const auto momentum = [&] {
    return Vec3(world.poses()[1].rotation * inertia.cwiseProduct(velocity(world)));
  };
  const double energy = world.energy_J();
  const Vec3 before = momentum();
  for (int k = 0; k < 50000; ++k) world.step({}, 1e-4);
  CHECK(world.energy_J() == Approx(energy).epsilon(5e-3));
  CHECK((momentum() - before).norm() < 5e-3 * before.norm());
}

TEST_CASE("friction of a ball joint acts against the angular velocity, with one bound") {
  World world(ball(0, 0.05));
  world.set_joint(0, spinning({0, 0, 4}));
  for (int k = 0; k < 4000; ++k) world.step({}, 1e-4);
  // I dω/dt = −τ_c
  CHECK(velocity(world).z() == Approx(4 - 0.05 / 0.01 * 0.4).epsilon(1e-9));
  CHECK(velocity(world).head<2>().norm() < 1e-12);
  for (int k = 0; k < 6000; ++k) world.step({}, 1e-4);
  CHECK(velocity(world).norm() == 0.0);
}

TEST_CASE("a ball joint sticks while the load is below its friction, in any direction") {
  // A load along x + z: each axis alone would hold 0.06, together they do not.
  World sticking(ball(0, 0.09, {0, -9.81, 0}, {0.006, 0, 0.006}));
  World falling(ball(0, 0.08, {0, -9.81, 0}, {0.006, 0, 0.006}));
  for (int k = 0; k < 1000; ++k) sticking.step({}, 1e-3), falling.step({}, 1e-3);
  CHECK(velocity(sticking).norm() < 1e-12);
  CHECK(velocity(falling).norm() > 1e-3);
}

TEST_CASE("a hinge stops at its limits and leaves them freely") {
  erp::Robot limited = pendulum(0.5);
  limited.skeletons[0].joints[0].min_rad = -0.2;
  World world(limited);
  double lowest = 1, highest_after = -1;
  bool has_touched = false;
  for (int k = 0; k < 5000; ++k) {
    world.step({}, 1e-3);
    lowest = std::min(lowest, angle(world));
    has_touched |= angle(world) < -0.199;
    if (has_touched) highest_after = std::max(highest_after, angle(world));
  }
  CHECK(lowest == Approx(-0.2).margin(1e-6));
  CHECK(highest_after > 0.1);
}

TEST_CASE("the rotation angle of a ball joint stays within its limit") {
  erp::Robot limited = ball();
  limited.skeletons[0].joints[0].max_rad = 0.7;
  World world(limited);
  world.set_joint(0, spinning({1, 2, -1}));
  double largest = 0;
  for (int k = 0; k < 2000; ++k) {
    world.step({}, 1e-3);
    const auto& q = world.joints()[0].position;
    largest = std::max(largest, 2 * std::acos(std::min(1.0, std::abs(q[0]))));
  }
  CHECK(largest == Approx(0.7).margin(2e-3));
}

TEST_CASE("a locked joint keeps its initial angle") {
  World world(pendulum(0.4), {.lock = {"hinge"}});
  const Vec3 before = world.poses()[1].rotation * Vec3(0, 0, -1);
  for (int k = 0; k < 100; ++k) world.step({}, 1e-3);
  CHECK((world.poses()[1].rotation * Vec3(0, 0, -1) - before).norm() == 0.0);
  CHECK(before.isApprox(Vec3(-std::sin(0.4), 0, -std::cos(0.4)), 1e-12));
  CHECK(angle(world) == 0.4);
  CHECK_THROWS_AS(World(pendulum(0), {.lock = {"hinch"}}), std::invalid_argument);
}

TEST_CASE("a robot that is not a tree is rejected") {
  const auto hinge = [](const char* parent, const char* child) {
    return joint("j", erp::JointType::revolute, parent, child);
  };
  const erp::Body rod = bone("rod", 1, {0, 0, 0}, {1, 1, 1});
  CHECK_THROWS_AS(World(robot({root(), rod}, {hinge("rod", "rod")})), std::invalid_argument);
  CHECK_THROWS_AS(World(robot({root(), rod}, {})), std::invalid_argument);
  CHECK_THROWS_AS(World(robot({root(), rod}, {hinge("base", "rod"), hinge("base", "rod")})),
                  std::invalid_argument);
  CHECK_THROWS_AS(World(robot({root(), root("rod")}, {hinge("base", "rod")})),
                  std::invalid_argument);
}
