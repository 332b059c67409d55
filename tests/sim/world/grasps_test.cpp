#include "sim/world/grasps.hpp"

#include <catch2/catch.hpp>

#include "tests/sim/rigs.hpp"

namespace {

erp::Robot twin() { return erp::read_robot(rigs::config("twin_joint/robot.xml")); }

/// The same robot with the weight in robot.xml.
erp::Robot loaded_twin() {
  erp::Robot robot = twin();
  for (erp::Skeleton& part : robot.skeletons)
    for (erp::Body& body : part.bodies)
      if (body.name == "forearm") body.parts.push_back(erp::Weight{{}, {0.01, 0, -0.26}, 0.2, ""});
  return robot;
}

sim::Grasp grasp(double at_s, double for_s = 1e9) {
  sim::Grasp g;
  g.body = "forearm", g.at_m = {0.01, 0, -0.26}, g.mass_kg = 0.2, g.at_s = at_s, g.for_s = for_s;
  return g;
}

void fall(sim::World& world, int steps) {
  const std::vector<double> pulls(4, 5.0);
  for (int k = 0; k < steps; ++k) world.step_pulled(pulls, 0.001);
}

}  // namespace

TEST_CASE("a robot that has taken a weight up moves as one that was built with it") {
  sim::World taking(twin()), built(loaded_twin());
  sim::Grasps grasps({grasp(0)}, taking);
  REQUIRE(grasps.befall(taking).size() == 1);
  fall(taking, 500), fall(built, 500);
  for (std::size_t j = 0; j < 2; ++j)
    CHECK(taking.joints()[j].position[0] == Approx(built.joints()[j].position[0]).margin(1e-12));
}

TEST_CASE("before it takes the weight up and after it lets go it moves without") {
  sim::World bare(twin()), taking(twin());
  sim::Grasps grasps({grasp(0.1, 0.1)}, taking);
  CHECK(grasps.befall(taking).empty());
  fall(taking, 101), fall(bare, 101);
  CHECK(taking.joints()[1].position == bare.joints()[1].position);
  CHECK(grasps.befall(taking).size() == 1);
  fall(taking, 100), fall(bare, 100);
  CHECK(std::abs(taking.joints()[1].position[0] - bare.joints()[1].position[0]) > 1e-3);
  CHECK(grasps.befall(taking).size() == 1);
  const double energy_J = taking.energy_J();
  sim::World again(twin());
  again.restore(taking.save());
  CHECK(again.energy_J() == Approx(energy_J));
}

TEST_CASE("what is held is saved and restored, and forgotten at a reset") {
  sim::World world(twin()), other(twin());
  sim::Grasps grasps({grasp(0)}, world);
  grasps.befall(world);
  fall(world, 50);
  other.restore(world.save());
  fall(world, 200), fall(other, 200);
  CHECK(other.joints()[1].position == world.joints()[1].position);
  world.reset();
  sim::World fresh(twin());
  fall(world, 100), fall(fresh, 100);
  CHECK(fresh.joints()[1].position == world.joints()[1].position);
}

TEST_CASE("a body that there is not, or that cannot carry, is refused") {
  sim::World world(twin());
  sim::Grasp g = grasp(0);
  g.body = "tail";
  CHECK_THROWS_WITH(sim::Grasps({g}, world), Catch::Contains("tail"));
  g.body = "base";
  CHECK_THROWS_WITH(sim::Grasps({g}, world), Catch::Contains("cannot carry"));
}
