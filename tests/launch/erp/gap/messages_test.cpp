#include "launch/erp/gap/messages.hpp"

#include <catch2/catch.hpp>

#include "tests/sim/rigs.hpp"

namespace {

erp::Robot hinge_rig() { return erp::read_robot(rigs::config("hinge_rig/robot.xml")); }

}  // namespace

TEST_CASE("a tendon that is longer than a zero may be off is told as that, with what to add") {
  const erp::Robot robot = hinge_rig();
  const auto doubt = [&](double length_m) {
    sim::diagnosis::IdentifiedEffect n{"tendon_length_offset", "flexor"};
    n.values = {length_m};
    return launch::gap::zero_doubt({n}, robot);
  };
  const double radius_m = robot.actuators[0].spindle.radius_m;
  CHECK(doubt(0.9 * radius_m).empty());
  CHECK_THAT(doubt(-3 * radius_m), Catch::Contains("a zero that is 3 rad off") &&
                                       Catch::Contains("add -3 to the column"));
}

TEST_CASE("what of an effect was not fitted is said beside what was") {
  const auto said = [](const char* type) {
    return launch::gap::taken_as_it_is(
        sim::diagnosis::named(sim::effects::Placed{"forearm", *sim::effects::neutral(type)}));
  };
  CHECK_THAT(said("skeleton_payload"), Catch::StartsWith("; ") && Catch::Contains("not fitted"));
  CHECK(said("skeleton_mass").empty());
}

TEST_CASE("an answer with which the simulator comes no nearer is doubted") {
  const auto doubt = [](double before, double after) {
    sim::diagnosis::Closed run{.unit = "noise", .before = before, .floor = 1, .after = after};
    run.closed = (before - after) / (before - 1);
    sim::diagnosis::Diagnosis d;
    d.verdict = sim::diagnosis::Verdict::supported;
    return launch::gap::free_run_doubt(d, run);
  };
  CHECK_THAT(doubt(3.14, 3.05),
             Catch::Contains("off by 3.14 times") && Catch::Contains("with the effects by 3.05"));
  CHECK_FALSE(doubt(121, 223).empty());
  CHECK(doubt(48, 1.3).empty());
  CHECK(doubt(1.6, 1.5).empty());                      // a gap that hardly shows there
  CHECK_FALSE(doubt(0.99, 10.1).empty());              // it makes one
  CHECK_FALSE(doubt(45, 6.1).empty());                 // it leaves much
  CHECK(launch::gap::free_run_doubt({}, {}).empty());  // not run
}

TEST_CASE("a model without a gap that runs away from the robot is doubted") {
  sim::diagnosis::Closed run{.unit = "noise", .before = 15, .floor = 1, .after = 15};
  CHECK_THAT(launch::gap::free_run_doubt({}, run), Catch::Contains("15 times"));
  run.before = run.after = 1.2;
  CHECK(launch::gap::free_run_doubt({}, run).empty());
}

TEST_CASE("what speaks against an answer is said: a stage it opens, a clock, a late column") {
  using sim::effects::Stage;
  const erp::Robot robot = hinge_rig();
  sim::diagnosis::Diagnosis d;
  d.verdict = sim::diagnosis::Verdict::supported;
  d.stages = {{Stage::motor, "flexor"}, {Stage::gearbox, "flexor"}};
  d.stages[0].judged = d.stages[1].judged = d.stages[0].open = true;
  const auto say = [&] { return launch::gap::doubts(d, {}, robot); };
  d.unexplained = {{Stage::motor, "flexor", 8}};
  CHECK(say().empty());
  d.unexplained = {{Stage::gearbox, "flexor", 8}};
  REQUIRE(say().size() == 1);
  CHECK_THAT(say()[0], Catch::Contains("opens a gap at the gearbox of flexor"));
  d.unexplained.clear();
  const auto named = [](const char* type, const char* on, double value) {
    sim::diagnosis::IdentifiedEffect n{type, on};
    n.values = {value};
    return n;
  };
  d.answer = {named("motor_torque_constant", "flexor", 0.005),
              named("motor_torque_constant", "extensor", 0.0051)};
  REQUIRE(say().size() == 1);
  const std::string time = say()[0];
  CHECK_THAT(time, Catch::Contains("time_s running 0.51 % too fast"));
  d.answer[1].values = {0.009};
  CHECK(say().empty());
  CHECK_THAT(time, Catch::Contains("voltages recorded that much too high"));
  d.answer = {named("sensor_joint_low_pass", "elbow", 0.01)};
  REQUIRE(say().size() == 1);
  CHECK_THAT(say()[0], Catch::Contains("delayed by 10 ms"));
  d.answer = {named("tendon_damping", "flexor", -12)};
  CHECK(say().empty());
  d.answer[0].alternatives = {named("sensor_tension_low_pass", "flexor", 0.002)};
  REQUIRE(say().size() == 1);
  CHECK_THAT(say()[0], Catch::Contains("a column of flexor that is some ms behind the others"));
  d.answer.clear();
  for (const char* on : {"flexor", "extensor"}) {
    sim::diagnosis::ConstantEstimate c{"torque_Nm_per_A", on, Stage::motor, 0.0115, 0.05, 0.01035};
    c.interval = {0.0103, 0.0104};
    d.constants.push_back(c);
  }
  REQUIRE(say().size() == 1);
  CHECK_THAT(say()[0], Catch::Contains("time_s running 10 % too slowly") &&
                           Catch::Contains("voltages recorded that much too low"));
}
