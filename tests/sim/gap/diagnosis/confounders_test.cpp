#include "sim/gap/diagnosis/confounders.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/sim/gap/residuals/rig_recording.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::diagnosis;

namespace {

Evaluator rig_evaluator() {
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

std::vector<std::string> names_of(const Indistinguishable& pair) {
  std::vector<std::string> names;
  for (const auto& other : pair.others) names.push_back(sim::effects::name_of(other));
  return names;
}

}  // namespace

TEST_CASE(
    "a gain error of the shaft sensor is reproduced by a torque constant with a spindle radius, "
    "but "
    "not by a single effect") {
  const Evaluator evaluator = rig_evaluator();
  CHECK(of_type(confounders(evaluator, {.share = 0.06, .most = 1}), "sensor_shaft_gain").empty());
  const auto two = of_type(confounders(evaluator, {.share = 0.06, .most = 2}), "sensor_shaft_gain");
  REQUIRE(two.size() == 2);  // flexor and extensor
  for (const Indistinguishable& pair : two) {
    CHECK_THAT(names_of(pair), Catch::UnorderedEquals(std::vector<std::string>{
                                   "motor_torque_constant on " + pair.hidden.on,
                                   "spindle_radius on " + pair.hidden.on}));
  }
}

TEST_CASE("the most similar single effect is replaced if two others reproduce the change better") {
  // The single effect that is most similar to a drift of the angle is an offset.
  const Evaluator evaluator = rig_evaluator();
  const auto found =
      of_type(confounders(evaluator, {.share = 0.05, .most = 2}), "sensor_joint_drift");
  REQUIRE(found.size() == 1);
  CHECK_THAT(names_of(found[0]), Catch::UnorderedEquals(std::vector<std::string>{
                                     "spindle_slip on flexor", "spindle_slip on extensor"}));
}

TEST_CASE(
    "the confounder of an effect is the effect that is indistinguishable from it, with the same "
    "remainder") {
  const Evaluator evaluator = rig_evaluator();
  const auto pairs = of_type(indistinguishable_effects(evaluator, 0.1), "gearbox_shaft_compliance");
  const auto found = of_type(confounders(evaluator, {}), "gearbox_shaft_compliance");
  REQUIRE(found.size() == 2);  // flexor and extensor
  for (const Indistinguishable& pair : found) {
    REQUIRE(pair.others.size() == 1);
    const auto closest = std::ranges::min_element(pairs, {}, [&](const Indistinguishable& t) {
      return t.hidden.on == pair.hidden.on ? t.remaining : t.magnitude;
    });
    CHECK(pair.remaining == Approx(closest->remaining).epsilon(1e-3).margin(1e-4));
    CHECK(pair.magnitude == Approx(closest->magnitude));
  }
}

TEST_CASE("an effect is not a confounder of another effect of its type") {
  const Evaluator evaluator = rig_evaluator();
  std::vector<std::string> types;
  for (const auto& effect : sim::effects::library())
    types.emplace_back(sim::effects::about(effect).type);
  for (const std::string& only_type : types) {
    auto others = types;
    std::erase(others, only_type);
    CHECK(confounders(evaluator, {.share = 1 - 1e-6, .withhold = others}).empty());
  }
}

TEST_CASE("withheld types are neither listed nor confounders") {
  const Evaluator evaluator = rig_evaluator();
  const ConfounderOptions options{.withhold = {"tendon_kite_line"}};
  for (const Indistinguishable& pair : confounders(evaluator, options)) {
    CHECK(sim::effects::about(pair.hidden.effect).type != "tendon_kite_line");
    for (const auto& other : pair.others)
      CHECK(sim::effects::about(other.effect).type != "tendon_kite_line");
  }
}
