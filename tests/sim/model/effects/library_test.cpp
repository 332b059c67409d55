#include "sim/model/effects/library.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "interfaces/xml/xml.hpp"
#include "tests/sim/model/effects/magnitudes.hpp"
#include "tests/sim/rigs.hpp"

namespace effects = sim::effects;

namespace {

using rigs::hinge_rig;

std::string error_of(const erp::Effect& effect) {
  erp::Robot robot = hinge_rig();
  robot.effects = {effect};
  try {
    effects::read_effects(robot);
  } catch (const xml::Errors& errors) {
    return errors.what();
  }
  return "";
}

}  // namespace

TEST_CASE("types are unique and begin with their stage") {
  std::set<std::string> types;
  for (const auto& effect : effects::library()) {
    const effects::About& about = effects::about(effect);
    INFO(about.type);
    CHECK(types.insert(std::string(about.type)).second);
    CHECK(about.type.starts_with(effects::word(about.stage)));
    CHECK_FALSE(about.shown_by.empty());
  }
  CHECK(types.size() >= 45);
}

TEST_CASE("default values are within the bounds, and each effect has a fitted parameter") {
  for (auto effect : effects::library()) {
    INFO(effects::about(effect).type);
    int fitted = 0;
    for (const auto& p : effects::parameters(effect)) {
      INFO(p.name);
      CHECK(p.bounds.low <= *p.value);
      CHECK(*p.value <= p.bounds.high);
      fitted += p.fitted;
    }
    CHECK(fitted >= 1);
  }
}

TEST_CASE("an effect with default parameters does not change the robot") {
  const std::string unchanged = erp::write_robot(hinge_rig());
  for (const auto& effect : effects::library()) {
    erp::Robot robot = hinge_rig();
    robot.effects = {effects::written({magnitudes::place_in_rig(effect), effect})};
    INFO(effects::about(effect).type);
    erp::Robot equipped = effects::equip(robot).robot;
    for (auto& actuator : equipped.actuators) actuator.motor = robot.actuators[0].motor;
    equipped.motor_types = {equipped.motor_types.back()};
    equipped.motor_types[0].name = robot.actuators[0].motor;
    CHECK(erp::write_robot(equipped) == unchanged);
  }
}

TEST_CASE("written effects are read with the same parameters") {
  for (const auto& [type, values] : magnitudes::all()) {
    INFO(type);
    const auto effect = magnitudes::visible(type);
    erp::Robot robot = hinge_rig();
    robot.effects = {effects::written({magnitudes::place_in_rig(effect), effect})};
    const erp::Robot read = xml::parse<erp::Robot>(erp::write_robot(robot), "rig.xml");
    auto read_effects = effects::read_effects(read);
    REQUIRE(read_effects.size() == 1);
    auto changed_effect = effect;
    const auto expected = effects::parameters(changed_effect),
               actual = effects::parameters(read_effects[0].effect);
    for (std::size_t k = 0; k < expected.size(); ++k) CHECK(*actual[k].value == *expected[k].value);
  }
}

TEST_CASE("errors in effects are reported with a suggestion") {
  CHECK_THAT(error_of({{}, "gearbox_backlahs", "flexor", {}}),
             Catch::Contains("did you mean \"gearbox_backlash\""));
  CHECK_THAT(error_of({{}, "gearbox_backlash", "elbow", {}}),
             Catch::Contains("names no actuator") && Catch::Contains("flexor"));
  CHECK_THAT(error_of({{}, "gearbox_backlash", "flexor", {{{}, "with_rad", "0.1"}}}),
             Catch::Contains("did you mean \"width_rad\""));
  CHECK_THAT(error_of({{}, "gearbox_backlash", "flexor", {{{}, "width_rad", "7"}}}),
             Catch::Contains("width_rad=\"7\""));
  CHECK_THAT(error_of({{}, "gearbox_backlash", "flexor", {{{}, "width_rad", "much"}}}),
             Catch::Contains("width_rad=\"much\""));
}

TEST_CASE("an effect on the motor of one actuator does not change another actuator") {
  erp::Robot robot = hinge_rig();
  robot.effects = {{{}, "motor_resistance", "flexor", {{{}, "relative", "0.5"}}},
                   {{}, "motor_resistance", "flexor", {{{}, "relative", "0.5"}}}};
  const erp::Robot changed = effects::equip(robot).robot;
  CHECK(changed.motor_of(changed.actuators[0]).resistance_ohm == Approx(0.516 * 2.25));
  CHECK(changed.motor_of(changed.actuators[1]).resistance_ohm == 0.516);
}

TEST_CASE("the kite line softens the spring, and also acts in each step with the path length") {
  erp::Robot robot = hinge_rig();
  robot.effects = {{{}, "tendon_kite_line", "flexor", {{{}, "compliance_m_per_N", "1e-4"}}}};
  const auto [changed, acting] = effects::equip(robot);
  CHECK(*changed.actuators[0].tendon.line_stiffness_N_per_m == Approx(1e4));
  REQUIRE(acting.size() == 1);
  CHECK(effects::name_of(acting[0]) == "tendon_kite_line on flexor");
}

TEST_CASE("a payload changes mass, centre of mass and inertia by the parallel axis theorem") {
  erp::Robot robot = hinge_rig();
  robot.effects = {{{}, "skeleton_payload", "forearm", {{{}, "mass_kg", "0.2"}}}};
  const erp::Body body = effects::equip(robot).robot.bodies()[1];
  CHECK(body.mass_kg == Approx(1.0));
  CHECK(body.com_m[2] == Approx(-(0.8 * 0.12 + 0.2 * 0.25)));
  const double about_joint = body.inertia_kg_m2[1] + body.mass_kg * body.com_m[2] * body.com_m[2];
  CHECK(about_joint == Approx(0.01752 + 0.2 * 0.25 * 0.25));
}

TEST_CASE(
    "base tilt rotates gravity, and link flexibility keeps mass, centre of mass and inertia") {
  erp::Robot robot = hinge_rig();
  robot.effects = {
      {{}, "skeleton_base_tilt", "hinge_rig", {{{}, "about_y_rad", "0.1"}}},
      {{}, "skeleton_link_flexibility", "forearm", {{{}, "compliance_rad_per_Nm", "0.1"}}}};
  const auto [changed, acting] = effects::equip(robot);
  const auto g = changed.gravity_m_per_s2();
  CHECK(g[0] == Approx(9.81 * std::sin(0.1)));  // in the frame of the base rotated about y
  CHECK(g[2] == Approx(-9.81 * std::cos(0.1)));
  REQUIRE(changed.bodies().size() == 3);
  const auto bodies = changed.bodies();
  const erp::Body &inner = bodies[1], &outer = bodies[2];
  const double outer_z = changed.joints()[1].at_m[2] + outer.com_m[2];
  CHECK(inner.mass_kg + outer.mass_kg == Approx(0.8));
  CHECK(0.5 * (inner.com_m[2] + outer_z) == Approx(-0.12));
  const double about_elbow = inner.inertia_kg_m2[1] + outer.inertia_kg_m2[1] +
                             0.4 * (inner.com_m[2] * inner.com_m[2] + outer_z * outer_z);
  CHECK(about_elbow == Approx(0.01752));
  REQUIRE(acting.size() == 1);  // the spring between the halves
  CHECK(acting[0].on == "forearm_bend");
}

TEST_CASE("link flexibility also applies to a bone made of solids") {
  erp::Robot arm = erp::read_robot(rigs::config("arm/robot.xml"));
  const std::size_t bodies = arm.bodies().size();
  arm.effects = {
      {{}, "skeleton_link_flexibility", "forearm", {{{}, "compliance_rad_per_Nm", "0.1"}}}};
  CHECK(effects::equip(arm).robot.bodies().size() == bodies + 1);
}
