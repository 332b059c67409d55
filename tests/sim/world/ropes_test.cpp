#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "sim/world/world.hpp"
#include "tests/sim/rigs.hpp"

namespace {

/// The hinge rig with a flexor that is a rope over the same pulley.
erp::Robot rope_rig(int nodes = 120) {
  erp::Robot robot = erp::read_robot(rigs::config("hinge_rig/robot.xml"));
  auto& path = robot.actuators[0].tendon.path;
  path = {path.front(), path[path.size() - 2], path.back()};
  robot.actuators[0].rope = erp::Rope{{}, nodes, 0.004, 0, 0, ""};
  return robot;
}

erp::Robot virtual_rig() {
  erp::Robot robot = rope_rig();
  robot.actuators[0].rope.reset();
  return robot;
}

double settled_rad(sim::World& world, const std::vector<double>& voltage_V) {
  for (int k = 0; k < 400; ++k) world.step(voltage_V, 0.001);
  for (int k = 0; k < 1500; ++k) world.step(std::vector<double>(2, 0.0), 0.001);
  return world.joints()[0].position[0];
}

}  // namespace

TEST_CASE("a rope moves the joint like a tendon without rope dynamics") {
  sim::World rope(rope_rig()), path(virtual_rig());
  const std::vector<double> voltage_V{4.0, -2.0};
  const double a = settled_rad(rope, voltage_V), b = settled_rad(path, voltage_V);
  CHECK(std::abs(b) > 0.1);
  CHECK(a == Approx(b).margin(0.01));
  CHECK(rope.actuators()[0].tension_N == Approx(path.actuators()[0].tension_N).epsilon(0.02));
  CHECK(rope.rope(0)->failed_steps() == 0);
  CHECK(path.rope(0) == nullptr);
}

/// The hinge rig with a rope, friction, and two bodies that form a groove in the rope's path.
erp::Robot groove_rig() {
  erp::Robot robot = rope_rig();
  robot.actuators[0].rope->friction = 0.2;
  robot.actuators[0].rope->radius_m = 0.001;
  erp::Body& base = robot.skeletons[0].bodies[0];
  for (const double y : {-0.02, 0.02})
    base.parts.push_back(erp::Sphere{{}, {-0.025, y, 0.15}, 0.025});
  return robot;
}

TEST_CASE("a rope over two bodies starts with its pretension and rests in their groove") {
  sim::World world(groove_rig());
  CHECK(world.actuators()[0].tension_N == Approx(5).epsilon(0.01));
  for (int k = 0; k < 300; ++k) world.step(std::vector<double>{2.0, -0.5}, 0.001);
  CHECK(world.rope(0)->failed_steps() == 0);
  std::set<double> sides;
  for (const auto& force : world.rope(0)->forces())
    if (force.at_m.z() > 0.1 && force.at_m.z() < 0.2)
      sides.insert(std::copysign(1, force.force_N.y()));
  CHECK(sides.size() == 2);  // both bodies are pushed, in opposite directions
}

TEST_CASE("a rope with too few nodes for a body is rejected with the required number") {
  erp::Robot robot = groove_rig();
  robot.actuators[0].rope->nodes = 5;
  CHECK_THROWS_WITH(sim::World(robot), Catch::Contains("flexor") && Catch::Contains("give nodes="));
}

TEST_CASE("a rope follows when set_joint moves its joint") {
  sim::World world(rope_rig());
  world.set_joint(0, {erp::JointType::revolute, {-0.2}, {}, {}, {}});
  CHECK(world.rope(0)->failed_steps() == 0);
  CHECK(world.actuators()[0].length_m == Approx(world.path(0).length_m).epsilon(1e-3));
}

TEST_CASE("a world with a rope continues from a saved state bit by bit") {
  const erp::Robot robot = GENERATE(rope_rig(), groove_rig());
  sim::World original(robot), other(robot);
  const std::vector<double> voltage_V{1.0, 0.2};
  for (int k = 0; k < 100; ++k) original.step(voltage_V, 0.001);
  other.restore(original.save());
  for (int k = 0; k < 100; ++k) original.step(voltage_V, 0.001), other.step(voltage_V, 0.001);
  CHECK(original.joints()[0].position == other.joints()[0].position);
  CHECK(original.actuators()[0].tension_N == other.actuators()[0].tension_N);
  CHECK(original.rope(0)->state().nodes_m == other.rope(0)->state().nodes_m);
  erp::Robot coarse = robot;
  coarse.actuators[0].rope->nodes = 60;
  CHECK_THROWS_AS(sim::World(coarse).restore(original.save()), std::invalid_argument);
}

TEST_CASE("a rope too stiff for its load is unstable, and the unstable steps are counted") {
  erp::Robot robot = rope_rig();
  robot.actuators[0].tendon.stiffness_N_per_m = 1e8;
  sim::World world(robot);
  for (int k = 0; k < 500; ++k) world.step(std::vector<double>(2, 0.5), 0.001);
  CHECK(world.rope(0)->failed_steps() > 0);
  CHECK(std::isfinite(world.joints()[0].position[0]));
}
