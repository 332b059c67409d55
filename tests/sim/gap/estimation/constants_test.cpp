#include "sim/gap/estimation/constants.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <optional>

#include "interfaces/xml/errors.hpp"
#include "sim/gap/estimation/far_off.hpp"
#include "sim/gap/residuals/stages.hpp"
#include "sim/model/effects/library.hpp"
#include "tests/sim/gap/diagnosis/blind_recording.hpp"

using namespace sim::estimation;
using blind_recording::hinge_rig;

namespace {

erp::Tolerance relative(const char* of, const char* on, double relative_tolerance) {
  erp::Tolerance given;
  given.of = of, given.on = on, given.relative = relative_tolerance;
  return given;
}

erp::Tolerance absolute(const char* of, double tolerance) {
  erp::Tolerance given;
  given.of = of, given.absolute = tolerance;
  return given;
}

/// The tolerance in the number's unit; empty if the number is not estimated.
std::optional<double> tolerance_of(const erp::Robot& robot, const char* on, const char* name) {
  for (const Constant& c : constants_of(robot))
    if (c.on == on && c.name == name) return c.tolerance;
  return std::nullopt;
}

std::string message_of(const erp::Tolerance& given) {
  erp::Robot robot = hinge_rig();
  robot.tolerances = {given};
  try {
    constants_of(robot);
  } catch (const xml::Errors& e) {
    return e.what();
  }
  return "";
}

/// Σ over stages of |r' − r|²/|r|², in windows that both judge.
double difference(const sim::residuals::Explanation& a, const sim::residuals::Explanation& b) {
  double sum = 0;
  for (std::size_t s = 0; s < a.residuals.size(); ++s) {
    double square = 0, change = 0;
    for (std::size_t k = 0; k < a.residuals[s].value.size(); ++k) {
      const double before = a.residuals[s].value[k], after = b.residuals[s].value[k];
      if (std::isnan(before) || std::isnan(after)) continue;
      square += before * before, change += (after - before) * (after - before);
    }
    if (square > 0) sum += change / square;
  }
  return sum;
}

}  // namespace

TEST_CASE("a change of a constant gives the residuals of the effect that represents it") {
  const erp::Robot robot = hinge_rig();
  const auto episode = blind_recording::episodes(blind_recording::nothing_hidden(), 6, 1)[0];
  const auto explain = [&](const erp::Robot& r) {
    return sim::residuals::Stages(r).explain(episode);
  };
  const auto nominal = explain(robot);
  const std::vector<Constant> constants = constants_of(robot);
  for (std::size_t k = 0; k < constants.size(); ++k) {
    const Constant& c = constants[k];
    CAPTURE(c.name, c.on, c.effect);
    std::vector<double> x(constants.size());
    x[k] = 1;
    erp::Robot with_effect = robot;
    with_effect.effects.push_back(sim::effects::written(as_effect(c, {k, x[k], 0}).effect));
    const auto by_constant = explain(with_constants(robot, constants, x));
    const double change = difference(nominal, by_constant);
    // The efficiency of the gearbox acts on the rotor's friction, but not on the friction of the
    // effect.
    const bool before_gearbox =
        c.name == "rotor_coulomb_Nm" || c.name == "rotor_viscous_Nm_s_per_rad";
    CHECK(difference(by_constant, explain(with_effect)) < (before_gearbox ? 0.15 : 1e-6) * change);
  }
}

TEST_CASE("a tolerance of robot.xml replaces the default for one part or for all") {
  erp::Robot robot = hinge_rig();
  robot.tolerances = {relative("resistance_ohm", "", 0.1),
                      relative("resistance_ohm", "flexor", 0.2), absolute("line_zero_m", 0.002)};
  CHECK(*tolerance_of(robot, "flexor", "resistance_ohm") == Approx(0.2 * 0.516));
  CHECK(*tolerance_of(robot, "extensor", "resistance_ohm") == Approx(0.1 * 0.516));
  CHECK(*tolerance_of(robot, "flexor", "line_zero_m") == Approx(0.002));
  CHECK(*tolerance_of(robot, "flexor", "radius_m") ==
        tolerance_of(hinge_rig(), "flexor", "radius_m"));
}

TEST_CASE("a number with tolerance 0 is not estimated") {
  erp::Robot robot = hinge_rig();
  robot.tolerances = {relative("mass", "forearm", 0)};
  CHECK_FALSE(tolerance_of(robot, "forearm", "mass"));
  CHECK(tolerance_of(hinge_rig(), "forearm", "mass"));
}

TEST_CASE("a tolerance of an unknown number is rejected with the nearest name") {
  CHECK(message_of(relative("resistance", "", 0.1)).find("did you mean \"resistance_ohm\"?") !=
        std::string::npos);
  CHECK(message_of(relative("resistance_ohm", "elbow", 0.1)).find("of elbow") != std::string::npos);
  CHECK(message_of(relative("line_zero_m", "", 0.1)).find("set absolute instead") !=
        std::string::npos);
}

TEST_CASE("an increase of the torque constant by 4 % increases the back-EMF constant by 4 %") {
  const erp::Robot robot = hinge_rig();
  const auto all = constants_of(robot);
  std::vector<double> x(all.size());
  for (std::size_t k = 0; k < all.size(); ++k)
    if (all[k].name == "torque_Nm_per_A" && all[k].on == "flexor") x[k] = 1;
  const erp::Robot built = with_constants(robot, all, x);
  const erp::MotorType &before = robot.motor_of(robot.actuators[0]),
                       &after = built.motor_of(built.actuators[0]);
  CHECK(after.torque_Nm_per_A == Approx(1.04 * before.torque_Nm_per_A));
  CHECK(after.back_emf_V_s_per_rad == Approx(1.04 * before.back_emf_V_s_per_rad));
  CHECK(std::ranges::none_of(all,
                             [](const Constant& c) { return c.name == "back_emf_V_s_per_rad"; }));
}

TEST_CASE("the value of a constant is limited to the bounds of its effect") {
  const erp::Robot robot = hinge_rig();
  const auto all = constants_of(robot);
  for (const double x : {-1e4, 1e4})
    CHECK_NOTHROW(
        sim::effects::read_effects(with_constants(robot, all, std::vector<double>(all.size(), x))));
}

TEST_CASE(
    "steps of a stiffness add to its reciprocal and keep it positive; steps of other numbers add") {
  for (const Constant& c : constants_of(hinge_rig())) {
    if (c.on != "flexor") continue;
    if (c.name == "stiffness_N_per_m") {
      const double stiffness_N_per_m = c.value(2), step_N_per_m = 0.1 * stiffness_N_per_m;
      CHECK(1 / c.value(c.moved(2, step_N_per_m / c.tolerance)) ==
            Approx(1 / stiffness_N_per_m - step_N_per_m / (stiffness_N_per_m * stiffness_N_per_m)));
      CHECK(c.value(c.moved(2, -10 * stiffness_N_per_m / c.tolerance)) ==
            Approx(stiffness_N_per_m / 11));
      CHECK(c.value(c.moved(2, 2 * stiffness_N_per_m / c.tolerance)) ==
            Approx(8 * stiffness_N_per_m));
    } else {
      CHECK(c.moved(2, 0.5) == 2.5);
    }
  }
}
