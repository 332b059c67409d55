#include "sim/world/world.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <numbers>

#include "tests/sim/skeletons.hpp"

using sim::World;

namespace {

using rigs::hinge_rig;

double length_at(World& world, int actuator, double angle) {
  sim::JointReading reading = world.joints()[0];
  reading.position[0] = angle;
  world.set_joint(0, reading);
  return world.actuators()[actuator].length_m;
}

/// The elbow's angle after 0.4 s under constant voltages.
double run_hinge(double dt) {
  World world(hinge_rig(), {.usual_step_s = dt});
  const std::vector<double> voltage{1.5, -0.2};
  for (int k = 0; k < std::lround(0.4 / dt); ++k) world.step(voltage, dt);
  return world.joints()[0].position[0];
}

}  // namespace

TEST_CASE("the hinge rig's moment arm is 25 mm over the whole range") {
  World world(hinge_rig());
  const double h = 1e-4;
  for (int actuator : {0, 1}) {
    const double sign = actuator == 0 ? -1 : 1;  // flexion shortens the flexor
    for (double q = -1.2 + h; q <= 1.6 - h; q += 0.01) {
      const double slope =
          (length_at(world, actuator, q + h) - length_at(world, actuator, q - h)) / (2 * h);
      REQUIRE(std::abs(slope - sign * 0.025) < 1e-6);
    }
  }
}

TEST_CASE("the unpowered rig keeps its pretension by gear friction") {
  World world(hinge_rig());
  CHECK(world.actuators()[0].tension_N == Approx(5));
  const std::vector<double> off(2, 0.0);
  for (int k = 0; k < 3000; ++k) world.step(off, 1e-3);
  CHECK(std::abs(world.joints()[0].position[0]) < 1e-3);
  CHECK(world.actuators()[0].tension_N == Approx(5).margin(0.05));
  CHECK(world.actuators()[0].shaft_rad == 0.0);
}

TEST_CASE("tension, shaft, joint and their speeds belong to the same instant") {
  World world(hinge_rig());
  const erp::Actuator flexor = world.robot().actuators[0];
  const double r = flexor.spindle.radius_m, start_m = world.actuators()[0].length_m;
  const auto law_N = [&] {
    const sim::ActuatorReading& a = world.actuators()[0];
    const sim::JointReading& elbow = world.joints()[0];
    const double stretch_m = a.length_m - start_m + r * a.shaft_rad;
    const double rate = -0.025 * elbow.velocity_rad_per_s[0] + r * a.speed_rad_per_s;
    return 5 + flexor.tendon.stiffness_N_per_m * stretch_m + flexor.tendon.damping_N_s_per_m * rate;
  };
  double worst_N = 0;
  for (int k = 0; k < 1000; ++k) {
    world.step(std::vector<double>{4 + 3 * std::sin(0.02 * k), 0}, 1e-3);
    worst_N = std::max(worst_N, std::abs(world.actuators()[0].tension_N - law_N()));
  }
  CHECK(worst_N < 1e-3);
  world.snap(0);
  world.step(std::vector<double>(2, 0.0), 1e-3);
  CHECK(world.actuators()[0].tension_N == 0);
}

TEST_CASE("winding up the flexor flexes the elbow") {
  World world(hinge_rig());
  const std::vector<double> voltage{3, -3};
  for (int k = 0; k < 500; ++k) world.step(voltage, 1e-3);
  CHECK(world.joints()[0].position[0] > 0.1);
  CHECK(world.actuators()[0].line_m < 0);
  CHECK(world.actuators()[1].line_m > 0);
}

TEST_CASE("the two tendons and the forearm oscillate at √(2 κ r² + m g l) / I") {
  erp::Robot rig = hinge_rig();
  auto& elbow = rig.skeletons[0].joints[0];
  elbow.viscous_Nm_s_per_rad = elbow.coulomb_Nm = 0;
  for (auto& actuator : rig.actuators) actuator.tendon.damping_N_s_per_m = 0;
  World world(rig);
  length_at(world, 0, 0.01);
  const std::vector<double> off(2, 0.0);
  const double dt = 1e-4;
  double before = 0.01, first = 0, last = 0;
  int crossings = 0;
  while (crossings < 11) {
    world.step(off, dt);
    const double now = world.joints()[0].position[0];
    if (before > 0 && now <= 0) {
      last = world.time_s() - dt * now / (now - before);
      if (++crossings == 1) first = last;
    }
    before = now;
  }
  const double stiffness = 2 * 6000 * 0.025 * 0.025 + 0.8 * 9.81 * 0.12;
  CHECK(2 * std::numbers::pi * 10 / (last - first) ==
        Approx(std::sqrt(stiffness / rigs::pendulum_I_kg_m2)).epsilon(1e-4));
}

TEST_CASE("halving the step halves the error") {
  const double exact = run_hinge(2e-6);
  const double coarse = std::abs(run_hinge(4e-4) - exact), fine = std::abs(run_hinge(2e-4) - exact);
  CHECK(std::log2(coarse / fine) == Approx(1).margin(0.15));
}

TEST_CASE("a repeated run, and a run after a reset, are identical to the last bit") {
  const auto run = [](World& world) {
    std::vector<double> trace;
    for (int k = 0; k < 2000; ++k) {
      const std::vector<double> voltage{3 * std::sin(0.01 * k), 2 * std::cos(0.013 * k)};
      world.step(voltage, 1e-3);
      trace.push_back(world.joints()[0].position[0]);
      trace.push_back(world.actuators()[0].tension_N);
      trace.push_back(world.actuators()[1].shaft_rad);
    }
    return trace;
  };
  World world(hinge_rig()), second_world(hinge_rig());
  const auto first = run(world), second = run(second_world);
  CHECK(std::memcmp(first.data(), second.data(), first.size() * sizeof(double)) == 0);
  world.reset();
  const auto third = run(world);
  CHECK(std::memcmp(first.data(), third.data(), first.size() * sizeof(double)) == 0);
}

TEST_CASE("a wrong number of voltages is rejected") {
  World world(hinge_rig());
  CHECK_THROWS_AS(world.step(std::vector<double>(3), 1e-3), std::invalid_argument);
}

TEST_CASE(
    "a free arm conserves its energy within 0.1 J for ten seconds at 1 ms, and within 0.01 J at "
    "0.1 ms") {
  erp::Robot arm = erp::read_robot(rigs::config("arm/robot.xml"));
  arm.actuators.clear();
  for (auto& joint : arm.skeletons[0].joints) {
    joint.viscous_Nm_s_per_rad = joint.coulomb_Nm = 0;
    joint.min_rad = -1000, joint.max_rad = 1000;
  }
  const auto worst_J = [&](double dt) {
    World world(arm);
    world.set_joint(0, {erp::JointType::spherical, {0.8, 0.6, 0, 0}, {}});
    const double start = world.energy_J();
    double worst = 0;
    for (int k = 0; k < std::lround(10 / dt); ++k) {
      world.step({}, dt);
      worst = std::max(worst, std::abs(world.energy_J() - start));
    }
    return worst;
  };
  // It starts 5 J above its lowest point; Bullet's own step gains 7 J in this time.
  CHECK(worst_J(1e-3) < 0.1);
  CHECK(worst_J(1e-4) < 0.01);
}

TEST_CASE("tendons of 1e4 N/m do not oscillate at 1 ms") {
  erp::Robot arm = erp::read_robot(rigs::config("arm/robot.xml"));
  for (auto& actuator : arm.actuators) {
    actuator.tendon.stiffness_N_per_m = 1e4;
    actuator.tendon.damping_N_s_per_m = 20;
  }
  for (auto& joint : arm.skeletons[0].joints) joint.coulomb_Nm = 0;
  World world(arm);
  const std::vector<double> off(11, 0.0);
  for (int k = 0; k < 5000; ++k) world.step(off, 1e-3);
  for (const auto& joint : world.joints())
    for (double speed : joint.velocity_rad_per_s) CHECK(std::abs(speed) < 1e-2);
}

TEST_CASE("a restored world continues like the saved one, bit by bit") {
  const erp::Robot robot = erp::read_robot(rigs::config("arm/robot.xml"));
  World original(robot), second_world(robot);
  std::vector<double> voltage_V(11, 0.0);
  const auto drive = [&](World& world, int from, int to) {
    for (int i = from; i < to; ++i) {
      for (std::size_t k = 0; k < 11; ++k)
        voltage_V[k] = std::sin(0.01 * i + static_cast<double>(k));
      world.step(voltage_V, 1e-3);
    }
  };
  drive(original, 0, 700);
  drive(second_world, 300, 350);  // to a different state
  second_world.restore(original.save());
  drive(original, 700, 1500);
  drive(second_world, 700, 1500);
  for (std::size_t k = 0; k < 11; ++k) {
    CHECK(original.actuators()[k].tension_N == second_world.actuators()[k].tension_N);
    CHECK(original.actuators()[k].shaft_rad == second_world.actuators()[k].shaft_rad);
  }
  for (std::size_t j = 0; j < 2; ++j)
    CHECK(original.joints()[j].position == second_world.joints()[j].position);
  CHECK(original.time_s() == second_world.time_s());
  CHECK_THROWS_AS(second_world.restore({}), std::invalid_argument);
}
