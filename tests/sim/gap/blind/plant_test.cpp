#include "sim/gap/blind/plant.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "sim/gap/blind/case.hpp"
#include "sim/gap/blind/joint_load.hpp"
#include "sim/gap/blind/visibility.hpp"
#include "sim/world/world.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::blind;

namespace {

using rigs::hinge_rig;
HiddenEffects no_effects(const erp::Robot& robot) {
  return draw_case(robot, Kind::null, 1).hidden_effects;
}

}  // namespace

TEST_CASE(
    "without hidden effects the blind plant agrees with the simulator within 0.01 rad and 1 N") {
  const erp::Robot robot = hinge_rig();
  Plant plant(robot, no_effects(robot));
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

TEST_CASE("every tendon of every robot starts at its pretension") {
  for (const char* name : {"hinge_rig", "leg", "arm", "seven_dof", "ecce4"}) {
    const erp::Robot robot = erp::read_robot(rigs::config(std::string(name) + "/robot.xml"));
    Plant plant(robot, no_effects(robot));
    REQUIRE(plant.run(std::vector<double>(robot.actuators.size()), 1e-5, 0));
    for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
      CAPTURE(name, robot.actuators[a].name);
      CHECK(plant.tension_N(a) == Approx(robot.actuators[a].tendon.pretension_N).margin(0.1));
    }
  }
}

TEST_CASE("friction in one actuator channel slows only that channel") {
  const erp::Robot robot = hinge_rig();
  const auto shaft_after = [&](const HiddenEffects& hidden_effects) {
    Plant plant(robot, hidden_effects);
    const double volts[] = {3, 0};
    REQUIRE(plant.run(volts, 0.3, 0));
    return plant.shaft_rad(0);
  };
  const double nominal = shaft_after(no_effects(robot));
  HiddenEffects with_friction = no_effects(robot), friction_in_other = no_effects(robot);
  with_friction.channels[0].dry_Nm = 1;
  friction_in_other.channels[1].dry_Nm = 1;
  CHECK(shaft_after(with_friction) < 0.95 * nominal);
  CHECK(shaft_after(friction_in_other) == Approx(nominal).epsilon(0.01));
}

TEST_CASE("a seed always draws the same case, and other seeds draw other cases") {
  const erp::Robot robot = hinge_rig();
  const auto first = draw_case(robot, Kind::pair, 7), same = draw_case(robot, Kind::pair, 7);
  REQUIRE(first.hidden.size() == 2);
  CHECK(first.hidden[0].type == same.hidden[0].type);
  CHECK(first.hidden[1].parameters == same.hidden[1].parameters);
  int different = 0;
  for (std::uint64_t seed = 8; seed < 18; ++seed)
    different += draw_case(robot, Kind::pair, seed).hidden[0].type != first.hidden[0].type;
  CHECK(different > 5);
  CHECK_THROWS_AS(kind_of("singles"), std::invalid_argument);
}

TEST_CASE("a case of kind many has 8 to 12 constants that deviate by 2 to 10 %") {
  const erp::Robot robot = hinge_rig();
  HiddenEffects unchanged = no_effects(robot);
  const AsBuilt exact = as_built(robot, 0, 1, unchanged);
  std::vector<int> counts;
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    const AsBuilt built = draw_case(robot, Kind::many, seed).built;
    REQUIRE(built.drawn.size() == exact.drawn.size());
    int deviating = 0;
    for (std::size_t k = 0; k < exact.drawn.size(); ++k) {
      const double error = std::abs(built.drawn[k].value / exact.drawn[k].value - 1);
      if (error < 1e-12 || exact.drawn[k].name == "torque_Nm_per_A")
        continue;  // K_T shares its factor with K_E
      ++deviating;
      CHECK(error >= 0.02 * (1 - 1e-9));
      CHECK(error <= 0.10 * (1 + 1e-9));
    }
    counts.push_back(deviating);
  }
  CHECK(std::ranges::min(counts) >= 8);
  CHECK(std::ranges::max(counts) <= 12);
  CHECK(std::ranges::min(counts) < std::ranges::max(counts));
}

TEST_CASE("an effect that is not visible in any reading is drawn again") {
  const erp::Robot robot = hinge_rig();
  const Visibility is_visible(robot);
  HiddenEffects nothing = no_effects(robot), sag = nothing, heavy = nothing;
  sag.channels[0].source_ohm = 1e-4;
  heavy.bodies["forearm"].mass = 0.3;
  CHECK_FALSE(is_visible(nothing));
  CHECK_FALSE(is_visible(sag));
  CHECK(is_visible(heavy));
  int calls = 0;
  const auto third_is_visible = [&](const HiddenEffects&) { return ++calls == 3; };
  const Case drawn = draw_case(robot, Kind::single, 7, {}, third_is_visible);
  CHECK(drawn.rejected_draws == 2);
  CHECK(drawn.hidden.size() == 1);
}

TEST_CASE("the joint load of the elbow is half the sum of tension limits times moment arms") {
  constexpr double tendons = 2, max_tension_N = 150, moment_arm_m = 0.025;  // of hinge_rig
  CHECK(joint_load_Nm(hinge_rig(), 0) ==
        Approx(tendons * max_tension_N * moment_arm_m / 2).epsilon(0.01));
}

TEST_CASE("an encoder with an eccentric disc reads the angle between disc centre and head") {
  erp::Robot robot = hinge_rig();
  const auto angles = [&](double sine) {
    Case blind = draw_case(robot, Kind::null, 1);
    blind.hidden_effects.joints[0].angle.sine_rad = sine;
    const auto table = record(robot, blind, sim::excitation(robot, 0, 4, 1), 1);
    return table.find("elbow.angle_rad")->values;
  };
  constexpr double eccentricity = 0.2;
  const auto centred = angles(0), eccentric = angles(eccentricity);
  double worst_rad = 0;
  for (std::size_t k = 0; k < centred.size(); ++k) {
    const double q = centred[k];
    const double ray = q + std::atan2(eccentricity * std::sin(q), 1 - eccentricity * std::cos(q));
    worst_rad = std::fmax(worst_rad, std::abs(eccentric[k] - ray));
  }
  CHECK(worst_rad < 0.004);  // noise and quantization of both readings
}
