#include "sim/gap/diagnosis/confounders.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/sim/gap/residuals/rig_recording.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::diagnosis;

namespace {

Evaluator rig_trials() {
  const erp::Robot rig = erp::read_robot(rigs::config("hinge_rig/robot.xml"));
  return {rig, {rig_recording::record(rig, rig, {.seconds = 20})}};
}

std::vector<Indistinguishable> of_type(std::vector<Indistinguishable> all,
                                       const std::string& type) {
  std::erase_if(all, [&](const Indistinguishable& t) {
    return sim::effects::about(t.hidden.effect).type != type;
  });
  return all;
}

std::vector<std::string> names_of(const Indistinguishable& twin) {
  std::vector<std::string> names;
  for (const auto& other : twin.others) names.push_back(sim::effects::name_of(other));
  return names;
}

}  // namespace

TEST_CASE("a shaft told too long is a stronger motor on a wider spindle, and neither alone") {
  const Evaluator evaluator = rig_trials();
  CHECK(of_type(confounders(evaluator, {.share = 0.06, .most = 1}), "sensor_shaft_gain").empty());
  const auto two = of_type(confounders(evaluator, {.share = 0.06, .most = 2}), "sensor_shaft_gain");
  REQUIRE(two.size() == 2);  // flexor and extensor
  for (const Indistinguishable& twin : two) {
    CHECK_THAT(names_of(twin), Catch::UnorderedEquals(std::vector<std::string>{
                                   "motor_torque_constant on " + twin.hidden.on,
                                   "spindle_radius on " + twin.hidden.on}));
  }
}

TEST_CASE("what is likest alone is let go where two others leave less") {
  const Evaluator evaluator = rig_trials();  // an angle that drifts is likest one that is off
  const auto found =
      of_type(confounders(evaluator, {.share = 0.05, .most = 2}), "sensor_joint_drift");
  REQUIRE(found.size() == 1);
  CHECK_THAT(names_of(found[0]), Catch::UnorderedEquals(std::vector<std::string>{
                                     "spindle_slip on flexor", "spindle_slip on extensor"}));
}

TEST_CASE("a twin needs no other beside it, and leaves what it leaves alone") {
  const Evaluator evaluator = rig_trials();
  const auto pairs = of_type(indistinguishable_effects(evaluator, 0.1), "gearbox_shaft_compliance");
  const auto few = of_type(confounders(evaluator, {}), "gearbox_shaft_compliance");
  REQUIRE(few.size() == 2);  // flexor and extensor
  for (const Indistinguishable& twin : few) {
    REQUIRE(twin.others.size() == 1);
    const auto least = std::ranges::min_element(pairs, {}, [&](const Indistinguishable& t) {
      return t.hidden.on == twin.hidden.on ? t.left : t.shows;
    });
    CHECK(twin.left == Approx(least->left).epsilon(1e-3).margin(1e-4));
    CHECK(twin.shows == Approx(least->shows));
  }
}

TEST_CASE("no effect stands for another of its own type") {
  const Evaluator evaluator = rig_trials();
  std::vector<std::string> types;
  for (const auto& effect : sim::effects::library())
    types.emplace_back(sim::effects::about(effect).type);
  for (const std::string& alone : types) {
    auto others = types;
    std::erase(others, alone);
    CHECK(confounders(evaluator, {.share = 1 - 1e-6, .withhold = others}).empty());
  }
}

TEST_CASE("types withheld neither hide nor stand for another") {
  const Evaluator evaluator = rig_trials();
  const ConfounderOptions options{.withhold = {"tendon_kite_line"}};
  for (const Indistinguishable& twin : confounders(evaluator, options)) {
    CHECK(sim::effects::about(twin.hidden.effect).type != "tendon_kite_line");
    for (const auto& other : twin.others)
      CHECK(sim::effects::about(other.effect).type != "tendon_kite_line");
  }
}
