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

TEST_CASE("two physics of the nominal rig agree: nothing hidden, no gap") {
  const Diagnosis d = diagnose(hinge_rig(), episodes(nothing_hidden()));
  CHECK(d.verdict == Verdict::no_gap);
  CHECK(d.where.empty());
  CHECK(d.answer.empty());
}

TEST_CASE("a hidden effect is named, sized, and closes the gap on recordings held out") {
  auto blind = nothing_hidden();
  blind.hidden_effects.chains[1].viscous = 0.02;  // extensor
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
  const auto stage = std::ranges::find(d.channels, "gearbox extensor", &Closed::channel);
  REQUIRE(stage != d.channels.end());
  CHECK(stage->closed > 0.9);
  CHECK(stage->interval.low <= stage->closed);
  CHECK(stage->interval.high >= stage->closed);
  CHECK(stage->interval.high - stage->interval.low < 0.1);
  for (const std::string& name : d.held_out) CHECK(std::ranges::count(d.train, name) == 0);
}

TEST_CASE(
    "an inertia that multiplies noisy accelerations is not too small, and its interval holds") {
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

TEST_CASE("a loose sensor of a joint is named: where it rests, the tendons tell of the bone") {
  auto blind = nothing_hidden();
  blind.hidden_effects.joints[0].loose_rad = 0.03;
  const Diagnosis d = diagnose(hinge_rig(), episodes(blind));
  REQUIRE(d.verdict == Verdict::supported);
  CHECK(d.answer[0].type == "joint_play");
  CHECK(value_of(d.answer[0], "width_rad") == Approx(0.03).epsilon(0.05));
  CHECK(d.overall.closed > 0.9);
}

TEST_CASE("withheld, it is none of the known, at its place") {
  auto blind = nothing_hidden();
  blind.hidden_effects.chains[0].dead_V = 0.4;  // flexor
  const Diagnosis d = diagnose(hinge_rig(), episodes(blind), {.withhold = {"motor_dead_band"}});
  CHECK(d.verdict == Verdict::none_of_the_known);
  REQUIRE_FALSE(d.where.empty());
  CHECK(d.where[0].on == "flexor");
  REQUIRE_FALSE(d.unexplained.empty());
  CHECK(d.unexplained[0].shape.has_value());
}

TEST_CASE("a law of another shape is not known, however much of it an effect closes") {
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

TEST_CASE("two effects at once are both named") {
  auto blind = nothing_hidden();
  blind.hidden_effects.chains[0].ohm = 0.3;
  blind.hidden_effects.joints[0].viscous = 0.15;
  const Diagnosis d = diagnose(hinge_rig(), episodes(blind));
  CHECK(d.verdict == Verdict::supported);
  std::vector<std::string> types;
  for (const IdentifiedEffect& n : d.answer) types.push_back(n.type + " " + n.on);
  CHECK(std::ranges::count(types, "motor_resistance flexor") == 1);
  CHECK(std::ranges::count(types, "joint_viscous elbow") == 1);
  double shapley_values = 0;
  for (const IdentifiedEffect& n : d.answer) {
    CHECK(n.supported);
    CHECK(n.gain > 0.05);
    shapley_values += n.gain;
  }
  CHECK(shapley_values == Approx(1).margin(0.03));  // together they close all
  CHECK(std::abs(d.interaction) < 0.1);             // and each its own stage
}

TEST_CASE("the same effect on every muscle of a leg is named on each") {
  const erp::Robot leg = erp::read_robot(rigs::config("leg/robot.xml"));
  auto blind = sim::blind::draw_case(leg, sim::blind::Kind::null, 1);
  for (auto& chain : blind.hidden_effects.chains) chain.dead_V = 0.4;
  std::vector<std::string> withheld;  // to be quick
  for (const auto& effect : sim::effects::library())
    if (sim::effects::about(effect).stage != sim::effects::Stage::motor)
      withheld.emplace_back(sim::effects::about(effect).type);
  const Problem problem{leg, episodes(blind, 6, 3, leg), {.withhold = withheld}, {{0, 1}, {2}}};
  const Evaluator evaluator(leg, problem.episodes, problem.options.seed);
  const auto stages =
      localize(evaluator, evaluator.bare(), problem.sets.all(), problem.localization_options());
  const Selection selection = select(problem, evaluator, stages);
  CHECK(selection.explained());
  CHECK(selection.answer.size() == leg.actuators.size());
  CHECK(selection.answer.size() > problem.options.most_effects);  // of one after another
  for (const IdentifiedEffect& n : selection.answer) CHECK(n.type == "motor_dead_band");
}

TEST_CASE("the shares of two effects on one stage add up, and what they share is interaction") {
  auto blind = nothing_hidden();
  blind.hidden_effects.chains[1].dry_Nm = 0.06;
  blind.hidden_effects.chains[1].viscous = 0.006;
  const Diagnosis d = diagnose(hinge_rig(), episodes(blind));
  REQUIRE(d.answer.size() == 2);
  CHECK(d.answer[0].gain + d.answer[1].gain == Approx(1).margin(0.03));
  CHECK(d.interaction < -0.1);  // both drag alike: alone, each takes a part of the other's
}

TEST_CASE("of what was not told, the interval is all that is allowed") {
  Ranked ranked{.fit = {{"flexor", *sim::effects::neutral("gearbox_viscous")}, 0, {}, {}}};
  ranked.fit.sigmas = {std::numeric_limits<double>::infinity()};
  const IdentifiedEffect n = identified(ranked, 0);
  CHECK(n.intervals.at(0).low == n.bounds.at(0).low);
  CHECK(n.intervals.at(0).high == n.bounds.at(0).high);
}

TEST_CASE("what sensors cannot tell apart is a set, not a guess") {
  auto blind = nothing_hidden();
  blind.hidden_effects.chains[0].knot_m = 4e-4;
  const Diagnosis d = diagnose(hinge_rig(), episodes(blind));
  REQUIRE(d.answer.size() == 1);
  REQUIRE(d.answer[0].alternatives.size() == 1);
  CHECK(d.answer[0].alternatives[0].type == "sensor_shaft_offset");
  CHECK(d.answer[0].type == "tendon_length_offset");
}

TEST_CASE("of two effects, what stands for one is not given to the other") {
  auto blind = nothing_hidden();
  blind.hidden_effects.chains[0].ohm = 0.3;
  blind.hidden_effects.chains[1].knot_m = 4e-4;
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
  double whole = 0;
  for (const Attribution& place : d.where) {
    whole += place.share;
    CHECK(place.on == (place.stage == sim::effects::Stage::motor ? "flexor" : "extensor"));
    CHECK((place.stage == sim::effects::Stage::motor) == (place.interval.low > 0));
  }
  CHECK(whole == Approx(1));
}

TEST_CASE("late, jittering and lost commands are told apart by their ages") {
  auto blind = nothing_hidden();
  const auto told = [&] { return diagnose(hinge_rig(), episodes(blind, 4)).answer.at(0); };
  SECTION("late") {
    blind.hidden_effects.command_delay_s = 0.013;
    const IdentifiedEffect n = told();
    CHECK(n.type == "bus_command_delay");
    CHECK(value_of(n, "delay_s") == Approx(0.013).margin(0.0012));
  }
  SECTION("jitter") {
    blind.hidden_effects.jitter_s = 0.02;
    const IdentifiedEffect n = told();
    CHECK(n.type == "bus_jitter");
    CHECK(value_of(n, "spread_s") == Approx(0.02).margin(0.002));
  }
  SECTION("lost") {
    blind.hidden_effects.loss = 0.4;
    const IdentifiedEffect n = told();
    CHECK(n.type == "bus_frame_loss");
    CHECK(value_of(n, "probability") == Approx(0.4).margin(0.03));
  }
  SECTION("late as no effect has it: the bus all the same") {
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

TEST_CASE("a gap that only the training recordings show is not identifiable") {
  auto blind = nothing_hidden();
  auto all = episodes(blind, 6, 2);
  blind.hidden_effects.chains[1].viscous = 0.02;
  all[0] = episodes(blind, 6, 1)[0];
  const Diagnosis d = diagnose(hinge_rig(), all, {.train = {0}, .held_out = {1}});
  CHECK(d.verdict == Verdict::not_identifiable);
  CHECK(d.answer.empty());
  REQUIRE_FALSE(d.warnings.empty());
}

TEST_CASE("what the recordings leave unjudged is said") {
  auto all = episodes(nothing_hidden());
  for (Episode& e : all)
    for (ActuatorSignals& s : e.actuators) s.current_A.clear();
  const Diagnosis d = diagnose(hinge_rig(), all);
  CHECK(d.verdict == Verdict::no_gap);
  REQUIRE(d.warnings.size() == 1);
  CHECK_THAT(d.warnings[0], Catch::Contains("motor of flexor, motor of extensor"));
}

TEST_CASE("where nothing can be judged there is no word of no gap") {
  const Diagnosis d = diagnose(hinge_rig(), episodes(nothing_hidden(), 0.1, 1));
  CHECK(d.verdict == Verdict::not_identifiable);
  CHECK_THAT(d.warnings.back(), Catch::Contains("nothing could be judged"));
}
