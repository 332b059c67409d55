#include <catch2/catch.hpp>

#include "sim/control/holding.hpp"
#include "sim/world/world.hpp"
#include "tests/sim/skeletons.hpp"

using Eigen::Vector3d;
using sim::JointReading, sim::World;

namespace {

constexpr double mass_kg = 0.4;

/// A free body whose centre of mass is not at its origin.
erp::Robot stone(xml::Vec3 gravity = {0, 0, -9.81}) {
  return rigs::robot(
      {rigs::root(), rigs::bone("stone", mass_kg, {0.05, -0.02, 0.03}, {2e-3, 3e-3, 4e-3})},
      {rigs::joint("float", erp::JointType::free, "base", "stone", {0.1, 0.2, 1.5})}, gravity);
}

JointReading thrown() {
  JointReading reading;
  reading.type = erp::JointType::free;
  reading.position = {1, 0, 0, 0};
  reading.velocity_rad_per_s = {3, -2, 5};
  reading.slide_m_per_s = {1, 0.5, 2};
  return reading;
}

Vector3d com(const World& world) {
  const sim::BodyPose& pose = world.poses()[1];
  return pose.position_m + pose.rotation * Vector3d(0.05, -0.02, 0.03);
}

Vector3d angular_momentum(const World& world) {
  const Vector3d w = world.poses()[1].rotation.transpose() * world.twists()[1].angular_rad_per_s;
  return world.poses()[1].rotation * w.cwiseProduct(Vector3d(2e-3, 3e-3, 4e-3));
}

/// A plate of 0.4 kg on eight tendons, two at each corner.
erp::Robot suspended_plate() {
  erp::Robot robot = stone();
  robot.motor_types = {rigs::caliper()};
  robot.skeletons[0].bodies[1].com_m = {0, 0, 0};
  int count = 0;
  for (const double x : {-0.1, 0.1})
    for (const double y : {-0.1, 0.1})
      for (const double z : {-0.3, 0.3}) {
        erp::Actuator a;
        a.name = "t" + std::to_string(count++), a.motor = "caliper_12V";
        a.spindle.radius_m = 0.0045;
        a.tendon.stiffness_N_per_m = 6000, a.tendon.damping_N_s_per_m = 20;
        a.tendon.path = {erp::Attach{{}, "base", {0.1 - 2 * x, 0.2 + 0.5 * y, 1.5 + z}},
                         erp::Attach{{}, "stone", {x, y, 0.1 * z}}};
        robot.actuators.push_back(a);
      }
  return robot;
}

}  // namespace

TEST_CASE(
    "the centre of mass of a thrown body follows a parabola and its angular momentum is constant") {
  World world(stone());
  world.set_joint(0, thrown());
  const Vector3d start = com(world), initial_spin = angular_momentum(world);
  const double dt = 0.001;
  for (int i = 0; i < 1000; ++i) world.step({}, dt);
  const Vector3d expected =
      start + Vector3d(1, 0.5, 2) -
      Vector3d(0, 0, 9.81) * (0.5 + dt / 2);  // the parabola of Euler's method
  CHECK((com(world) - expected).norm() < 1e-9);
  CHECK((angular_momentum(world) - initial_spin).norm() < 2e-3 * initial_spin.norm());
}

TEST_CASE("a freely rotating body conserves its energy") {
  World world(stone({0, 0, 0}));
  world.set_joint(0, thrown());
  const double energy = world.energy_J();
  for (int i = 0; i < 1000; ++i) world.step({}, 0.001);
  CHECK(world.energy_J() == Approx(energy).epsilon(1e-4));
}

TEST_CASE("a restored free flight continues bit by bit") {
  World world(suspended_plate()), other(suspended_plate());
  world.set_joint(0, thrown());
  const std::vector<double> voltage(8, 0.5);
  for (int i = 0; i < 100; ++i) world.step(voltage, 0.001);
  other.restore(world.save());
  for (int i = 0; i < 100; ++i) world.step(voltage, 0.001), other.step(voltage, 0.001);
  CHECK(world.joints()[0].position == other.joints()[0].position);
  CHECK(world.joints()[0].offset_m == other.joints()[0].offset_m);
  CHECK(world.joints()[0].slide_m_per_s == other.joints()[0].slide_m_per_s);
}

TEST_CASE("a body held only by tendons stays in the equilibrium of the tendons") {
  erp::Robot robot = suspended_plate();
  const sim::Holding holding = sim::hold_pose(robot, sim::starting_pose(robot));
  CHECK(holding.unbalanced_Nm < 1e-6);
  for (std::size_t k = 0; k < 8; ++k) robot.actuators[k].tendon.pretension_N = holding.tension_N[k];
  World world(robot);
  const std::vector<double> voltage(8, 0.0);
  for (int i = 0; i < 2000; ++i) world.step(voltage, 0.001);
  CHECK((world.poses()[1].position_m - Vector3d(0.1, 0.2, 1.5)).norm() < 0.01);
}

TEST_CASE("a free body can be locked, and must float relative to a root") {
  World world(stone(), {.lock = {"float"}});
  for (int i = 0; i < 10; ++i) world.step({}, 0.001);
  CHECK(world.poses()[1].position_m == Vector3d(0.1, 0.2, 1.5));
  erp::Robot robot = stone();
  robot.skeletons[0].bodies.push_back(rigs::bone("dust", 0.1, {0, 0, 0}, {1e-4, 1e-4, 1e-4}));
  robot.skeletons[0].joints.push_back(
      rigs::joint("float_too", erp::JointType::free, "stone", "dust"));
  CHECK_THROWS_WITH(World(robot),
                    Catch::Contains("\"dust\": the parent of a free joint must be a root"));
}
