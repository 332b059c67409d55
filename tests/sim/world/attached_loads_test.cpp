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
  sim::AttachedLoad attached;
  attached.body = "forearm", attached.at_m = {0.01, 0, -0.26}, attached.mass_kg = 0.2,
  attached.at_s = at_s, attached.for_s = for_s;
  return attached;
}

void fall(sim::World& world, int steps) {
  const std::vector<double> pulls(4, 5.0);
  for (int k = 0; k < steps; ++k) world.step_pulled(pulls, 0.001);
}

}  // namespace

TEST_CASE("a robot with an attached load moves like one with the mass in robot.xml") {
  sim::World attaching(twin()), built(loaded_twin());
  sim::AttachedLoads loads({load(0)}, attaching);
  REQUIRE(loads.update(attaching).size() == 1);
  fall(attaching, 500), fall(built, 500);
  for (std::size_t j = 0; j < 2; ++j)
    CHECK(attaching.joints()[j].position[0] == Approx(built.joints()[j].position[0]).margin(1e-12));
}

TEST_CASE("before the load is attached and after it is detached the robot moves without it") {
  sim::World bare(twin()), attaching(twin());
  sim::AttachedLoads loads({load(0.1, 0.1)}, attaching);
  CHECK(loads.update(attaching).empty());
  fall(attaching, 101), fall(bare, 101);
  CHECK(attaching.joints()[1].position == bare.joints()[1].position);
  CHECK(loads.update(attaching).size() == 1);
  fall(attaching, 100), fall(bare, 100);
  CHECK(std::abs(attaching.joints()[1].position[0] - bare.joints()[1].position[0]) > 1e-3);
  CHECK(loads.update(attaching).size() == 1);
  const double energy_J = attaching.energy_J();
  sim::World restored(twin());
  restored.restore(attaching.save());
  CHECK(restored.energy_J() == Approx(energy_J));
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
  sim::World new_world(twin());
  fall(world, 100), fall(new_world, 100);
  CHECK(new_world.joints()[1].position == world.joints()[1].position);
}

TEST_CASE(
    "an attached load on an unknown body, or on a body that cannot hold a load, is rejected") {
  sim::World world(twin());
  sim::AttachedLoad misplaced = load(0);
  misplaced.body = "tail";
  CHECK_THROWS_WITH(sim::AttachedLoads({misplaced}, world), Catch::Contains("tail"));
  misplaced.body = "base";
  CHECK_THROWS_WITH(sim::AttachedLoads({misplaced}, world), Catch::Contains("cannot hold a load"));
}
