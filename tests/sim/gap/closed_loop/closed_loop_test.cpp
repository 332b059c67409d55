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

/// Set-points of slow motions.
SetPoints slow(const erp::Robot& robot, double seconds) {
  return set_points_of(sim::excitation(robot, 0, seconds, 7));
}

}  // namespace

TEST_CASE("a predicted run follows its set-points and is reproduced bit by bit") {
  const erp::Robot robot = blind_recording::hinge_rig();
  const SetPoints set_points = slow(robot, 3);
  const auto table = predict_run(robot, set_points);
  REQUIRE(table.rows() == set_points.size());
  const double wound_m =
      -table.find("flexor.shaft_rad")->values.back() * robot.actuators[0].spindle.radius_m;
  CHECK(wound_m == Approx(set_points.back()[0].reference).margin(5e-3));
  const auto again = predict_run(robot, set_points);
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    CHECK(again.columns[c].values == table.columns[c].values);
}

TEST_CASE(
    "the hidden tendon damping closes 80 % of the error of a free run, another effect closes less "
    "than 50 %") {
  auto blind = blind_recording::nothing_hidden();
  blind.hidden_effects.channels[1].damping = 150;  // extensor
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

TEST_CASE("a recording without set-points in its first rows is used for the free run") {
  const erp::Robot robot = blind_recording::hinge_rig();
  auto recordings = blind_recording::episodes(blind_recording::nothing_hidden(), 6, 1);
  for (auto& actuator : recordings[0].actuators)
    for (std::size_t k = 0; k < 4; ++k)
      actuator.mode[k] = actuator.reference[k] = recording::not_taken;
  const FreeRun run = free_run(robot, robot, recordings, {.threads = 1});
  CHECK(run.remarks.empty());
  CHECK(run.all.before < 3);  // 527 if the robot stayed at rest
}

TEST_CASE(
    "in single missing rows the last command is held, and a gap of 30 rows excludes the "
    "recording") {
  const erp::Robot robot = blind_recording::hinge_rig();
  auto recordings = blind_recording::episodes(blind_recording::nothing_hidden(), 6, 1);
  const auto remove_rows = [&](std::size_t first, std::size_t count) {
    for (auto& actuator : recordings[0].actuators)
      for (std::size_t k = first; k < first + count; ++k)
        actuator.mode[k] = actuator.reference[k] = actuator.shaft_rad[k] = recording::not_taken;
  };
  for (std::size_t k = 100; k < 2900; k += 25) remove_rows(k, 1);
  const FreeRun run = free_run(robot, robot, recordings, {.threads = 1});
  CHECK(run.remarks.empty());
  CHECK(run.all.before < 3);
  remove_rows(1000, 30);
  const FreeRun excluded = free_run(robot, robot, recordings, {.threads = 1});
  REQUIRE(excluded.remarks.size() == 1);
  CHECK_THAT(excluded.remarks[0], Catch::Contains("rows are missing at 2 s"));
}

namespace {

/// An ECU with the law V = −1000 V/m (ref + r θ) − 0.1 V s/rad ω.
LearnedEcu foreign_ecu() {
  LearnedEcu ecu;
  for (std::size_t a = 0; a < 2; ++a) {
    LearnedLaw& law = ecu[{a, erp::Mode::length}];
    law.weights.setZero();
    law.weights[1] = -1000, law.weights[3] = 1000, law.weights[6] = -0.1;
  }
  return ecu;
}

std::vector<sim::residuals::Episode> recorded_under(const LearnedEcu& ecu,
                                                    const erp::Robot& robot) {
  std::vector<std::string> remarks;
  const auto table = predict_run(robot, slow(robot, 6), 3, {.learned = &ecu});
  return {sim::residuals::lay_out(table, blind_recording::hinge_rig(), "foreign ECU", remarks)};
}

}  // namespace

TEST_CASE("the law of an ECU with another firmware is learned, and the free run uses it") {
  const erp::Robot robot = blind_recording::hinge_rig();
  const LearnedEcu ecu = foreign_ecu();
  const auto recordings = recorded_under(ecu, robot);
  CHECK(unexplained_by_firmware(recordings, robot) > 0.05);
  const LearnedEcu learned = learn(recordings, robot);
  REQUIRE(learned.size() == 2);
  for (const auto& [which, law] : learned) {
    CHECK(which.second == erp::Mode::length);
    CHECK(law.lag == 1);
    CHECK(law.unexplained < 1e-3);
  }
  const auto damped = placed("tendon_damping", "extensor", 150);
  const FreeRun run =
      free_run(robot, rig_with(damped), recorded_under(ecu, rig_with(damped)), {.threads = 1});
  REQUIRE(run.remarks.size() == 1);
  CHECK_THAT(run.remarks[0], Catch::Contains("laws learned from the recordings"));
  CHECK(run.all.after < 3);
  CHECK(run.all.closed > 0.8);
}

TEST_CASE(
    "the firmware leaves less than 5 % of the variance of its own voltages unexplained, without "
    "and "
    "with a command delay of 20 ms") {
  const erp::Robot robot = blind_recording::hinge_rig();
  const auto without_delay = blind_recording::episodes(blind_recording::nothing_hidden(), 6, 2);
  CHECK(unexplained_by_firmware(without_delay, robot) < 0.05);
  auto delayed = blind_recording::nothing_hidden();
  delayed.hidden_effects.command_delay_s = 0.02;
  CHECK(unexplained_by_firmware(blind_recording::episodes(delayed, 6, 2), robot) < 0.05);
}

TEST_CASE("a recording that does not start in the initial pose is omitted with the reason") {
  auto recordings = blind_recording::episodes(blind_recording::nothing_hidden(), 3, 1);
  const erp::Robot robot = blind_recording::hinge_rig();
  recordings[0].joints[0].angle_rad[0] += 0.3;
  const FreeRun run = free_run(robot, robot, recordings, {.threads = 1});
  CHECK(run.channels.empty());
  REQUIRE(run.remarks.size() == 1);
  CHECK_THAT(run.remarks[0], Catch::Contains("elbow does not start"));
}

TEST_CASE(
    "the next experiment separates two frictions by more than 20 sigma and indistinguishable "
    "effects "
    "by less than 3") {
  const erp::Robot robot = blind_recording::hinge_rig();
  const ExperimentOptions quick{.seconds = 5, .candidates = 4};
  const auto coulomb = placed("gearbox_coulomb", "flexor", 0.03);
  const auto viscous = placed("gearbox_viscous", "flexor", 0.012);
  const Experiment separated = next_experiment(robot, {coulomb, viscous}, quick);
  CHECK(separated.candidates.front().least_split > 20);
  CHECK(separated.candidates.front().least_split >= separated.candidates[1].least_split);
  REQUIRE_FALSE(separated.chosen.reference.empty());
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const bool force = separated.chosen.mode == erp::Mode::force;
    CHECK(separated.chosen.reference[0][a] ==
          (force ? robot.actuators[a].tendon.pretension_N : 0.0));
  }
  CHECK(separated.candidates.front().extremes.tension_fraction < 0.85);
  for (const Candidate& c : separated.candidates) {
    CAPTURE(c.kind, c.extremes.saturated_fraction);
    if (c.kind == 0)
      CHECK(c.extremes.saturated_fraction > 0.5);  // steps over the full range saturate the motors
    if (c.kind == 1) CHECK(c.extremes.saturated_fraction < 0.2);  // small tensions
  }

  const auto offset = placed("tendon_length_offset", "flexor", 4e-4);
  const auto shaft = placed("sensor_shaft_offset", "flexor", 4e-4 / 0.0045);
  CHECK(next_experiment(robot, {offset, shaft}, quick).candidates.front().least_split < 3);
}

TEST_CASE("an excitation that overloads an actuator is not chosen") {
  erp::Robot robot = blind_recording::hinge_rig();
  for (erp::Actuator& actuator : robot.actuators) actuator.max_tension_N = 6;
  const Experiment rejected = next_experiment(robot, {placed("gearbox_coulomb", "flexor", 0.03)},
                                              {.seconds = 5, .candidates = 4});
  CHECK(rejected.chosen.reference.empty());
  CHECK_THAT(rejected.candidates[0].unsafe, Catch::Contains("of its limit"));
}

TEST_CASE("an excitation that comes nearer to a stop than the margin is not chosen") {
  const erp::Robot robot = blind_recording::hinge_rig();
  const auto with_margin = [&](double margin_rad) {
    return next_experiment(robot, {placed("gearbox_coulomb", "flexor", 0.03)},
                           {.seconds = 5, .candidates = 4, .stop_distance_rad = margin_rad});
  };
  const Experiment rejected = with_margin(2);  // more than half of the elbow's range
  CHECK(rejected.chosen.reference.empty());
  CHECK_THAT(rejected.candidates[0].unsafe, Catch::Contains("elbow comes within"));
  const Experiment accepted = with_margin(0.05);
  REQUIRE_FALSE(accepted.chosen.reference.empty());
  CHECK(accepted.candidates.front().extremes.stop_distance_rad > 0.05);
}
