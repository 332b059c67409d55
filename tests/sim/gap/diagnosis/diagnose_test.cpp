#include "sim/gap/diagnosis/diagnose.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

#include "sim/gap/diagnosis/selection.hpp"
#include "tests/sim/gap/diagnosis/blind_recording.hpp"

using namespace sim::diagnosis;
using namespace sim::residuals;
using blind_recording::episodes;
using blind_recording::hinge_rig;
using blind_recording::nothing_hidden;

namespace {

double value_of(const IdentifiedEffect& n, const std::string& name) {
  for (std::size_t k = 0; k < n.names.size(); ++k)
    if (n.names[k] == name) return n.values[k];
  return 0;
}

}  // namespace

TEST_CASE("the verdict without hidden effects is no gap") {
  const Diagnosis d = diagnose(hinge_rig(), episodes(nothing_hidden()));
  CHECK(d.verdict == Verdict::no_gap);
  CHECK(d.where.empty());
  CHECK(d.answer.empty());
}

TEST_CASE(
    "viscous friction of 0.02 N m s/rad in a gearbox is identified within its interval and closes "
    "90 % "
    "of the gap") {
  auto blind = nothing_hidden();
  blind.hidden_effects.channels[1].viscous = 0.02;  // extensor
  const Diagnosis d = diagnose(hinge_rig(), episodes(blind));
  REQUIRE(d.verdict == Verdict::supported);
  REQUIRE(d.answer.size() == 1);
  CHECK(d.answer[0].type == "gearbox_viscous");
  CHECK(d.answer[0].on == "extensor");
  CHECK(value_of(d.answer[0], "extra_Nm_s_per_rad") == Approx(0.02).epsilon(0.05));
  CHECK(d.answer[0].intervals[0].low < 0.02);
  CHECK(d.answer[0].intervals[0].high > 0.02);
  REQUIRE_FALSE(d.where.empty());
  CHECK(d.where[0].stage == sim::effects::Stage::gearbox);
  CHECK(d.where[0].on == "extensor");
  CHECK(d.overall.closed > 0.9);
  const auto stage = std::ranges::find(d.channels, "gearbox extensor", &ClosedGap::channel);
  REQUIRE(stage != d.channels.end());
  CHECK(stage->closed > 0.9);
  CHECK(stage->interval.low <= stage->closed);
  CHECK(stage->interval.high >= stage->closed);
  CHECK(stage->interval.high - stage->interval.low < 0.1);
  for (const std::string& name : d.held_out) CHECK(std::ranges::count(d.train, name) == 0);
}

TEST_CASE(
    "an inertia of a shank of +250 % is identified within its interval despite noisy "
    "accelerations") {
  const erp::Robot leg = erp::read_robot(rigs::config("leg/robot.xml"));
  auto blind = sim::blind::draw_case(leg, sim::blind::Kind::null, 1);
  blind.hidden_effects.bodies["shank"].inertia = 2.5;
  const Diagnosis d = diagnose(leg, episodes(blind, 12, 3, leg));
  REQUIRE(d.verdict == Verdict::supported);
  REQUIRE(d.answer.size() == 1);
  REQUIRE(d.answer[0].type == "skeleton_inertia");
  CHECK(value_of(d.answer[0], "relative") == Approx(2.5).epsilon(0.1));
  CHECK(d.answer[0].intervals[0].low < 2.5);
  CHECK(d.answer[0].intervals[0].high > 2.5);
}

TEST_CASE("play of 0.03 rad in a joint sensor is identified within 5 %") {
  auto blind = nothing_hidden();
  blind.hidden_effects.joints[0].play_rad = 0.03;
  const Diagnosis d = diagnose(hinge_rig(), episodes(blind));
  REQUIRE(d.verdict == Verdict::supported);
  CHECK(d.answer[0].type == "joint_play");
  CHECK(value_of(d.answer[0], "width_rad") == Approx(0.03).epsilon(0.05));
  CHECK(d.overall.closed > 0.9);
}

TEST_CASE("the verdict for a withheld effect is none of the known, at the true stage") {
  auto blind = nothing_hidden();
  blind.hidden_effects.channels[0].dead_V = 0.4;  // flexor
  const Diagnosis d = diagnose(hinge_rig(), episodes(blind), {.withhold = {"motor_dead_band"}});
  CHECK(d.verdict == Verdict::none_of_the_known);
  REQUIRE_FALSE(d.where.empty());
  CHECK(d.where[0].on == "flexor");
  REQUIRE_FALSE(d.unexplained.empty());
  CHECK(d.unexplained[0].shape.has_value());
}

TEST_CASE(
    "the verdict for quadratic drag is none of the known, although viscous friction closes 90 % of "
    "the gap") {
  auto blind = nothing_hidden();
  blind.hidden_effects.joints[0].drag = 0.12;  // grows with the square of the speed
  const Diagnosis d = diagnose(hinge_rig(), episodes(blind, 12, 4));
  CHECK(d.verdict == Verdict::none_of_the_known);
  REQUIRE(d.answer.size() == 1);
  CHECK(d.answer[0].type == "joint_viscous");
  CHECK(d.overall.closed > 0.9);
  REQUIRE(d.unexplained.size() == 1);
  REQUIRE(d.unexplained[0].shape.has_value());
  CHECK(d.unexplained[0].shape->variable == "joint speed");
}

TEST_CASE("a motor resistance and a simultaneous joint friction are both identified") {
  auto blind = nothing_hidden();
  blind.hidden_effects.channels[0].resistance = 0.3;
  blind.hidden_effects.joints[0].viscous = 0.15;
  const Diagnosis d = diagnose(hinge_rig(), episodes(blind));
  CHECK(d.verdict == Verdict::supported);
  std::vector<std::string> types;
  for (const IdentifiedEffect& n : d.answer) types.push_back(n.type + " " + n.on);
  CHECK(std::ranges::count(types, "motor_resistance flexor") == 1);
  CHECK(std::ranges::count(types, "joint_viscous elbow") == 1);
  double sum = 0;
  for (const IdentifiedEffect& n : d.answer) {
    CHECK(n.supported);
    CHECK(n.gain > 0.05);
    sum += n.gain;
  }
  CHECK(sum == Approx(1).margin(0.03));
  CHECK(std::abs(d.interaction) < 0.1);  // the effects act on different stages
}

TEST_CASE("a dead band on every muscle of a leg is identified on each muscle") {
  const erp::Robot leg = erp::read_robot(rigs::config("leg/robot.xml"));
  auto blind = sim::blind::draw_case(leg, sim::blind::Kind::null, 1);
  for (auto& channel : blind.hidden_effects.channels) channel.dead_V = 0.4;
  std::vector<std::string> withheld;  // to shorten the test
  for (const auto& effect : sim::effects::library())
    if (sim::effects::about(effect).stage != sim::effects::Stage::motor)
      withheld.emplace_back(sim::effects::about(effect).type);
  const Problem problem{leg, episodes(blind, 6, 3, leg), {.withhold = withheld}, {{0, 1}, {2}}};
  const Evaluator evaluator(leg, problem.episodes, problem.options.seed);
  const auto stages = localize(evaluator, evaluator.nominal_evaluation(), problem.sets.all(),
                               problem.localization_options());
  const Selection selection = select(problem, evaluator, stages);
  CHECK(selection.explained());
  CHECK(selection.answer.size() == leg.actuators.size());
  CHECK(selection.answer.size() >
        problem.options.most_effects);  // more than forward selection can find
  for (const IdentifiedEffect& n : selection.answer) CHECK(n.type == "motor_dead_band");
}

TEST_CASE(
    "the gains of two effects on one stage sum to 1, and their overlap is a negative interaction") {
  auto blind = nothing_hidden();
  blind.hidden_effects.channels[1].dry_Nm = 0.06;
  blind.hidden_effects.channels[1].viscous = 0.006;
  const Diagnosis d = diagnose(hinge_rig(), episodes(blind));
  REQUIRE(d.answer.size() == 2);
  CHECK(d.answer[0].gain + d.answer[1].gain == Approx(1).margin(0.03));
  CHECK(d.interaction <
        -0.1);  // both are friction: each single one removes part of the other's residual
}

TEST_CASE("the interval for an infinite standard error equals the bounds") {
  Ranked ranked{.fit = {{"flexor", *sim::effects::neutral("gearbox_viscous")}, 0, {}, {}}};
  ranked.fit.sigmas = {std::numeric_limits<double>::infinity()};
  const IdentifiedEffect n = identified(ranked, 0);
  CHECK(n.intervals.at(0).low == n.bounds.at(0).low);
  CHECK(n.intervals.at(0).high == n.bounds.at(0).high);
}

TEST_CASE("a length offset and a shaft offset are reported as indistinguishable") {
  auto blind = nothing_hidden();
  blind.hidden_effects.channels[0].length_offset_m = 4e-4;
  const Diagnosis d = diagnose(hinge_rig(), episodes(blind));
  REQUIRE(d.answer.size() == 1);
  REQUIRE(d.answer[0].alternatives.size() == 1);
  CHECK(d.answer[0].alternatives[0].type == "sensor_shaft_offset");
  CHECK(d.answer[0].type == "tendon_length_offset");
}

TEST_CASE("an alternative of one of two effects is not listed for the other") {
  auto blind = nothing_hidden();
  blind.hidden_effects.channels[0].resistance = 0.3;
  blind.hidden_effects.channels[1].length_offset_m = 4e-4;
  const Diagnosis d = diagnose(hinge_rig(), episodes(blind));
  REQUIRE(d.answer.size() == 2);
  const auto offset = std::ranges::find(d.answer, "tendon_length_offset", &IdentifiedEffect::type);
  const auto resistance = std::ranges::find(d.answer, "motor_resistance", &IdentifiedEffect::type);
  REQUIRE(offset != d.answer.end());
  REQUIRE(resistance != d.answer.end());
  REQUIRE(offset->alternatives.size() == 1);
  CHECK(offset->alternatives[0].type == "sensor_shaft_offset");
  CHECK(resistance->alternatives.empty());
  REQUIRE(d.where.size() == 3);
  double sum = 0;
  for (const Attribution& place : d.where) {
    sum += place.share;
    CHECK(place.on == (place.stage == sim::effects::Stage::motor ? "flexor" : "extensor"));
    CHECK((place.stage == sim::effects::Stage::motor) == (place.interval.low > 0));
  }
  CHECK(sum == Approx(1));
}

TEST_CASE("delay, jitter and loss of commands are identified by the ages of commands") {
  auto blind = nothing_hidden();
  const auto identified_effect = [&] {
    return diagnose(hinge_rig(), episodes(blind, 4)).answer.at(0);
  };
  SECTION("delay of 13 ms") {
    blind.hidden_effects.command_delay_s = 0.013;
    const IdentifiedEffect n = identified_effect();
    CHECK(n.type == "bus_command_delay");
    CHECK(value_of(n, "delay_s") == Approx(0.013).margin(0.0012));
  }
  SECTION("jitter of 20 ms") {
    blind.hidden_effects.jitter_s = 0.02;
    const IdentifiedEffect n = identified_effect();
    CHECK(n.type == "bus_jitter");
    CHECK(value_of(n, "spread_s") == Approx(0.02).margin(0.002));
  }
  SECTION("loss of 40 %") {
    blind.hidden_effects.loss = 0.4;
    const IdentifiedEffect n = identified_effect();
    CHECK(n.type == "bus_frame_loss");
    CHECK(value_of(n, "probability") == Approx(0.4).margin(0.03));
  }
  SECTION("ages that no allowed effect explains: the gap is attributed to the bus") {
    blind.hidden_effects.loss = 0.4;
    DiagnoseOptions options;
    options.withhold = {"bus_frame_loss"};
    const Diagnosis d = diagnose(hinge_rig(), episodes(blind, 4), options);
    CHECK(d.verdict == Verdict::none_of_the_known);
    REQUIRE(d.where.size() == 1);
    CHECK(d.where[0].stage == sim::effects::Stage::bus);
    CHECK(d.warnings.size() == 1);
  }
}

TEST_CASE("the verdict for a gap only in the training recordings is not identifiable") {
  auto blind = nothing_hidden();
  auto all = episodes(blind, 6, 2);
  blind.hidden_effects.channels[1].viscous = 0.02;
  all[0] = episodes(blind, 6, 1)[0];
  const Diagnosis d = diagnose(hinge_rig(), all, {.train = {0}, .held_out = {1}});
  CHECK(d.verdict == Verdict::not_identifiable);
  CHECK(d.answer.empty());
  REQUIRE_FALSE(d.warnings.empty());
}

TEST_CASE("for recordings without current a warning names the motors that are not evaluated") {
  auto all = episodes(nothing_hidden());
  for (Episode& e : all)
    for (ActuatorSignals& s : e.actuators) s.current_A.clear();
  const Diagnosis d = diagnose(hinge_rig(), all);
  CHECK(d.verdict == Verdict::no_gap);
  REQUIRE(d.warnings.size() == 1);
  CHECK_THAT(d.warnings[0], Catch::Contains("motor of flexor, motor of extensor"));
}

TEST_CASE("the verdict for a recording of 0.1 s is not identifiable, with a warning") {
  const Diagnosis d = diagnose(hinge_rig(), episodes(nothing_hidden(), 0.1, 1));
  CHECK(d.verdict == Verdict::not_identifiable);
  CHECK_THAT(d.warnings.back(), Catch::Contains("no stage could be evaluated"));
}
