#include "sim/world/attached_loads.hpp"

#include <catch2/catch.hpp>

#include "tests/sim/rigs.hpp"

namespace {

erp::Robot twin() { return erp::read_robot(rigs::config("twin_joint/robot.xml")); }

/// The same robot with the load as a mass in robot.xml.
erp::Robot loaded_twin() {
  erp::Robot robot = twin();
  for (erp::Skeleton& part : robot.skeletons)
    for (erp::Body& body : part.bodies)
      if (body.name == "forearm") body.parts.push_back(erp::Weight{{}, {0.01, 0, -0.26}, 0.2, ""});
  return robot;
}

sim::AttachedLoad load(double at_s, double for_s = 1e9) {
  sim::AttachedLoad g;
  g.body = "forearm", g.at_m = {0.01, 0, -0.26}, g.mass_kg = 0.2, g.at_s = at_s, g.for_s = for_s;
  return g;
}

void fall(sim::World& world, int steps) {
  const std::vector<double> pulls(4, 5.0);
  for (int k = 0; k < steps; ++k) world.step_pulled(pulls, 0.001);
}

}  // namespace

TEST_CASE("a robot with an attached load moves like one with the mass in robot.xml") {
  sim::World taking(twin()), built(loaded_twin());
  sim::AttachedLoads loads({load(0)}, taking);
  REQUIRE(loads.update(taking).size() == 1);
  fall(taking, 500), fall(built, 500);
  for (std::size_t j = 0; j < 2; ++j)
    CHECK(taking.joints()[j].position[0] == Approx(built.joints()[j].position[0]).margin(1e-12));
}

TEST_CASE("before the load is attached and after it is detached the robot moves without it") {
  sim::World bare(twin()), taking(twin());
  sim::AttachedLoads loads({load(0.1, 0.1)}, taking);
  CHECK(loads.update(taking).empty());
  fall(taking, 101), fall(bare, 101);
  CHECK(taking.joints()[1].position == bare.joints()[1].position);
  CHECK(loads.update(taking).size() == 1);
  fall(taking, 100), fall(bare, 100);
  CHECK(std::abs(taking.joints()[1].position[0] - bare.joints()[1].position[0]) > 1e-3);
  CHECK(loads.update(taking).size() == 1);
  const double energy_J = taking.energy_J();
  sim::World again(twin());
  again.restore(taking.save());
  CHECK(again.energy_J() == Approx(energy_J));
}

TEST_CASE("attached loads are saved and restored, and removed by a reset") {
  sim::World world(twin()), other(twin());
  sim::AttachedLoads loads({load(0)}, world);
  loads.update(world);
  fall(world, 50);
  other.restore(world.save());
  fall(world, 200), fall(other, 200);
  CHECK(other.joints()[1].position == world.joints()[1].position);
  world.reset();
  sim::World fresh(twin());
  fall(world, 100), fall(fresh, 100);
  CHECK(fresh.joints()[1].position == world.joints()[1].position);
}

TEST_CASE("an unknown body, or one that cannot hold a load, is refused") {
  sim::World world(twin());
  sim::AttachedLoad g = load(0);
  g.body = "tail";
  CHECK_THROWS_WITH(sim::AttachedLoads({g}, world), Catch::Contains("tail"));
  g.body = "base";
  CHECK_THROWS_WITH(sim::AttachedLoads({g}, world), Catch::Contains("cannot hold a load"));
}
