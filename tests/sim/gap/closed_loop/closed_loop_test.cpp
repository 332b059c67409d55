#include <catch2/catch.hpp>

#include "sim/gap/closed_loop/experiment.hpp"
#include "sim/gap/closed_loop/free_run.hpp"
#include "tests/sim/gap/diagnosis/blind_recording.hpp"

using namespace sim::closed_loop;
namespace effects = sim::effects;

namespace {

effects::Placed placed(const char* type, const char* on, double value) {
  effects::Placed p{on, *effects::neutral(type)};
  *effects::parameters(p.effect)[0].value = value;
  return p;
}

erp::Robot rig_with(const effects::Placed& effect) {
  erp::Robot robot = blind_recording::hinge_rig();
  robot.effects.push_back(effects::written(effect));
  return robot;
}

SetPoints slow(const erp::Robot& robot, double seconds) {
  return set_points_of(sim::excitation(robot, 0, seconds, 7));
}

}  // namespace

TEST_CASE("a rehearsal follows its score and is the same again bit by bit") {
  const erp::Robot robot = blind_recording::hinge_rig();
  const SetPoints score = slow(robot, 3);
  const auto table = predict_run(robot, score);
  REQUIRE(table.rows() == score.size());
  const double wound_m =
      -table.find("flexor.shaft_rad")->values.back() * robot.actuators[0].spindle.radius_m;
  CHECK(wound_m == Approx(score.back()[0].reference).margin(5e-3));
  const auto again = predict_run(robot, score);
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    CHECK(again.columns[c].values == table.columns[c].values);
}

TEST_CASE("let run freely, the right effect closes the gap to a robot of another physics") {
  auto blind = blind_recording::nothing_hidden();
  blind.hidden_effects.chains[1].damping = 150;  // extensor
  const auto recordings = blind_recording::episodes(blind, 6, 2);
  const erp::Robot nominal = blind_recording::hinge_rig();
  const erp::Robot found = rig_with(placed("tendon_damping", "extensor", 150));
  const FreeRun run = free_run(nominal, found, recordings, {.threads = 2});
  CHECK(run.remarks.empty());
  CHECK(run.all.before > 10);
  CHECK(run.all.closed > 0.8);
  CHECK(run.all.interval.low > 0.7);
  const FreeRun wrong = free_run(nominal, rig_with(placed("joint_viscous", "elbow", 0.1)),
                                 recordings, {.threads = 2});
  CHECK(wrong.all.closed < 0.5);
}

TEST_CASE(
    "a recording whose first rows nobody commanded, as the logger's, runs freely all the same") {
  const erp::Robot robot = blind_recording::hinge_rig();
  auto recordings = blind_recording::episodes(blind_recording::nothing_hidden(), 6, 1);
  for (auto& actuator : recordings[0].actuators)
    for (std::size_t k = 0; k < 4; ++k)
      actuator.mode[k] = actuator.reference[k] = recording::not_taken;
  const FreeRun run = free_run(robot, robot, recordings, {.threads = 1});
  CHECK(run.remarks.empty());
  CHECK(run.all.before < 3);  // it moves as the recording does: 527 where it rests
}

TEST_CASE("where rows are missing the last command goes on; where many are, it is not run freely") {
  const erp::Robot robot = blind_recording::hinge_rig();
  auto recordings = blind_recording::episodes(blind_recording::nothing_hidden(), 6, 1);
  const auto lose = [&](std::size_t first, std::size_t count) {
    for (auto& actuator : recordings[0].actuators)
      for (std::size_t k = first; k < first + count; ++k)
        actuator.mode[k] = actuator.reference[k] = actuator.shaft_rad[k] = recording::not_taken;
  };
  for (std::size_t k = 100; k < 2900; k += 25) lose(k, 1);
  const FreeRun run = free_run(robot, robot, recordings, {.threads = 1});
  CHECK(run.remarks.empty());
  CHECK(run.all.before < 3);
  lose(1000, 30);
  const FreeRun none = free_run(robot, robot, recordings, {.threads = 1});
  REQUIRE(none.remarks.size() == 1);
  CHECK_THAT(none.remarks[0], Catch::Contains("rows are missing at 2 s"));
}

namespace {

/// V = −1000 V/m (ref + r θ) − 0.1 V s/rad ω, as an ECU of somebody else's has it.
LearnedEcu somebody_elses() {
  LearnedEcu ecu;
  for (std::size_t a = 0; a < 2; ++a) {
    LearnedLaw& law = ecu[{a, erp::Mode::length}];
    law.weights.setZero();
    law.weights[1] = -1000, law.weights[3] = 1000, law.weights[6] = -0.1;
  }
  return ecu;
}

std::vector<sim::residuals::Episode> under(const LearnedEcu& ecu, const erp::Robot& robot) {
  std::vector<std::string> remarks;
  const auto table = predict_run(robot, slow(robot, 6), 3, {.learned = &ecu});
  return {sim::residuals::lay_out(table, blind_recording::hinge_rig(), "theirs", remarks)};
}

}  // namespace

TEST_CASE("the law of an ECU that is not ours is learned, and the free run uses it") {
  const erp::Robot robot = blind_recording::hinge_rig();
  const LearnedEcu ecu = somebody_elses();
  const auto theirs = under(ecu, robot);
  CHECK(unexplained_by_firmware(theirs, robot) > 0.05);
  const LearnedEcu learned = learn(theirs, robot);
  REQUIRE(learned.size() == 2);
  for (const auto& [which, law] : learned) {
    CHECK(which.second == erp::Mode::length);
    CHECK(law.lag == 1);
    CHECK(law.unexplained < 1e-3);
  }
  const auto damped = placed("tendon_damping", "extensor", 150);
  const FreeRun run =
      free_run(robot, rig_with(damped), under(ecu, rig_with(damped)), {.threads = 1});
  REQUIRE(run.remarks.size() == 1);
  CHECK_THAT(run.remarks[0], Catch::Contains("laws learned from the recordings"));
  CHECK(run.all.after < 3);
  CHECK(run.all.closed > 0.8);
}

TEST_CASE("our own firmware foretells the voltages that it applied") {
  const erp::Robot robot = blind_recording::hinge_rig();
  const auto ours = blind_recording::episodes(blind_recording::nothing_hidden(), 6, 2);
  CHECK(unexplained_by_firmware(ours, robot) < 0.05);
  auto late = blind_recording::nothing_hidden();
  late.hidden_effects.command_delay_s = 0.02;
  CHECK(unexplained_by_firmware(blind_recording::episodes(late, 6, 2), robot) < 0.05);
}

TEST_CASE("a recording that begins elsewhere is left out, and it is said why") {
  auto recordings = blind_recording::episodes(blind_recording::nothing_hidden(), 3, 1);
  const erp::Robot robot = blind_recording::hinge_rig();
  recordings[0].joints[0].angle_rad[0] += 0.3;
  const FreeRun run = free_run(robot, robot, recordings, {.threads = 1});
  CHECK(run.channels.empty());
  REQUIRE(run.remarks.size() == 1);
  CHECK_THAT(run.remarks[0], Catch::Contains("elbow does not start"));
}

TEST_CASE(
    "the next experiment splits what can be split, safely, and says of twins that none does") {
  const erp::Robot robot = blind_recording::hinge_rig();
  const ExperimentOptions quick{.seconds = 5, .candidates = 4};
  const auto coulomb = placed("gearbox_coulomb", "flexor", 0.03);
  const auto viscous = placed("gearbox_viscous", "flexor", 0.012);
  const Experiment apart = next_experiment(robot, {coulomb, viscous}, quick);
  CHECK(apart.candidates.front().least > 20);
  CHECK(apart.candidates.front().least >= apart.candidates[1].least);
  REQUIRE_FALSE(apart.chosen.reference.empty());
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const bool force = apart.chosen.mode == erp::Mode::force;
    CHECK(apart.chosen.reference[0][a] == (force ? robot.actuators[a].tendon.pretension_N : 0.0));
  }
  CHECK(apart.candidates.front().extremes.of_max_tension < 0.85);
  for (const Candidate& c : apart.candidates) {
    CAPTURE(c.kind, c.extremes.saturated);
    if (c.kind == 0) CHECK(c.extremes.saturated > 0.5);  // from end to end faster than motors go
    if (c.kind == 1) CHECK(c.extremes.saturated < 0.2);  // gentle tensions
  }

  const auto offset = placed("tendon_length_offset", "flexor", 4e-4);
  const auto shaft = placed("sensor_shaft_offset", "flexor", 4e-4 / 0.0045);
  CHECK(next_experiment(robot, {offset, shaft}, quick).candidates.front().least < 3);
}

TEST_CASE("what would overload an actuator is not chosen") {
  erp::Robot robot = blind_recording::hinge_rig();
  for (erp::Actuator& actuator : robot.actuators) actuator.max_tension_N = 6;
  const Experiment none = next_experiment(robot, {placed("gearbox_coulomb", "flexor", 0.03)},
                                          {.seconds = 5, .candidates = 4});
  CHECK(none.chosen.reference.empty());
  CHECK_THAT(none.candidates[0].unsafe, Catch::Contains("of its limit"));
}

TEST_CASE("what comes nearer to a stop than the margin is not chosen") {
  const erp::Robot robot = blind_recording::hinge_rig();
  const auto farthest = [&](double margin_rad) {
    return next_experiment(robot, {placed("gearbox_coulomb", "flexor", 0.03)},
                           {.seconds = 5, .candidates = 4, .to_stop_rad = margin_rad});
  };
  const Experiment none = farthest(2);  // more than half of the elbow's range
  CHECK(none.chosen.reference.empty());
  CHECK_THAT(none.candidates[0].unsafe, Catch::Contains("elbow comes within"));
  const Experiment some = farthest(0.05);
  REQUIRE_FALSE(some.chosen.reference.empty());
  CHECK(some.candidates.front().extremes.to_stop_rad > 0.05);
}
