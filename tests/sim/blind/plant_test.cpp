#include "sim/blind/plant.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "sim/blind/case.hpp"
#include "sim/world/world.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::blind;

namespace {

erp::Robot hinge_rig() { return erp::read_robot(rigs::config("hinge_rig/robot.xml")); }
Quirks no_quirks(const erp::Robot& robot) { return draw_case(robot, Kind::null, 1).quirks; }

}  // namespace

TEST_CASE(
    "without quirks the blind plant moves as the simulator does, though it shares no equation") {
  const erp::Robot robot = hinge_rig();
  Plant plant(robot, no_quirks(robot));
  sim::World world(robot);
  const int elbow = 0;
  double worst_rad = 0, worst_N = 0, moved_rad = 0;
  for (int k = 0; k < 1000; ++k) {
    const double t = 0.002 * k;
    const double volts[] = {2 + 2 * std::sin(3 * t), 2 - 2 * std::sin(3 * t)};
    REQUIRE(plant.run(volts, 0.002, 0));
    world.step(volts, 0.001), world.step(volts, 0.001);
    worst_rad =
        std::fmax(worst_rad, std::abs(plant.angle_rad(elbow) - world.joints()[elbow].position[0]));
    moved_rad = std::fmax(moved_rad, std::abs(world.joints()[elbow].position[0]));
    worst_N = std::fmax(worst_N, std::abs(plant.tension_N(0) - world.actuators()[0].tension_N));
  }
  CHECK(worst_rad < 0.01);
  CHECK(worst_N < 1.0);
  CHECK(moved_rad > 0.1);
}

TEST_CASE("a quirk changes what it is named for") {
  const erp::Robot robot = hinge_rig();
  const auto shaft_after = [&](const Quirks& quirks) {
    Plant plant(robot, quirks);
    const double volts[] = {3, 0};
    REQUIRE(plant.run(volts, 0.3, 0));
    return plant.shaft_rad(0);
  };
  const double nominal = shaft_after(no_quirks(robot));
  Quirks rubs = no_quirks(robot), torn = no_quirks(robot);
  rubs.chains[0].dry_Nm = 1;
  torn.chains[1].dry_Nm = 1;
  CHECK(shaft_after(rubs) < 0.95 * nominal);
  CHECK(shaft_after(torn) == Approx(nominal).epsilon(0.01));
}

TEST_CASE("a seed draws the same case again, another seed another") {
  const erp::Robot robot = hinge_rig();
  const auto one = draw_case(robot, Kind::pair, 7), same = draw_case(robot, Kind::pair, 7);
  REQUIRE(one.hidden.size() == 2);
  CHECK(one.hidden[0].type == same.hidden[0].type);
  CHECK(one.hidden[1].parameters == same.hidden[1].parameters);
  int others = 0;
  for (std::uint64_t seed = 8; seed < 18; ++seed)
    others += draw_case(robot, Kind::pair, seed).hidden[0].type != one.hidden[0].type;
  CHECK(others > 5);
  CHECK_THROWS_AS(kind_of("singles"), std::invalid_argument);
}
