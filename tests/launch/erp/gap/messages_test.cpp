#include "launch/erp/gap/messages.hpp"

#include <catch2/catch.hpp>

#include "tests/sim/rigs.hpp"

namespace {

using rigs::hinge_rig;

}  // namespace

TEST_CASE("a tendon length offset beyond any zero error: the warning contains the correction") {
  const erp::Robot robot = hinge_rig();
  const auto warning = [&](double length_m) {
    sim::diagnosis::IdentifiedEffect effect{"tendon_length_offset", "flexor"};
    effect.values = {length_m};
    return launch::gap::zero_offset_warning({effect}, robot);
  };
  const double radius_m = robot.actuators[0].spindle.radius_m;
  CHECK(warning(0.9 * radius_m).empty());
  CHECK_THAT(warning(-3 * radius_m), Catch::Contains("a zero that is 3 rad off") &&
                                         Catch::Contains("add -3 to the column"));
}

TEST_CASE("parameters that are not fitted are printed with the fitted ones") {
  const auto text = [](const char* type) {
    return launch::gap::fixed_parameters(
        sim::diagnosis::identified(sim::effects::Placed{"forearm", *sim::effects::neutral(type)}));
  };
  CHECK_THAT(text("skeleton_payload"), Catch::StartsWith("; ") && Catch::Contains("not fitted"));
  CHECK(text("skeleton_mass").empty());
}

TEST_CASE("an answer that does not reduce the free-run error causes a warning") {
  const auto warning = [](double before, double after) {
    sim::diagnosis::ClosedGap run{.unit = "noise", .before = before, .floor = 1, .after = after};
    run.closed = (before - after) / (before - 1);
    sim::diagnosis::Diagnosis diagnosis;
    diagnosis.verdict = sim::diagnosis::Verdict::supported;
    return launch::gap::free_run_warning(diagnosis, run);
  };
  CHECK_THAT(warning(3.14, 3.05), Catch::Contains("error is 3.14 times") &&
                                      Catch::Contains("with the identified effects 3.05 times"));
  CHECK_FALSE(warning(121, 223).empty());
  CHECK(warning(48, 1.3).empty());
  CHECK(warning(1.6, 1.5).empty());          // a gap that is hardly visible in the free run
  CHECK_FALSE(warning(0.99, 10.1).empty());  // the answer causes a gap
  CHECK_FALSE(warning(45, 6.1).empty());     // a large error remains
  CHECK(launch::gap::free_run_warning({}, {}).empty());  // no free run
}

TEST_CASE("a large free-run error of a model without a gap causes a warning") {
  sim::diagnosis::ClosedGap run{.unit = "noise", .before = 15, .floor = 1, .after = 15};
  CHECK_THAT(launch::gap::free_run_warning({}, run), Catch::Contains("15 times"));
  run.before = run.after = 1.2;
  CHECK(launch::gap::free_run_warning({}, run).empty());
}

TEST_CASE(
    "warnings about an answer: a stage that it opens, a scaled time column, a delayed column") {
  using sim::effects::Stage;
  const erp::Robot robot = hinge_rig();
  sim::diagnosis::Diagnosis diagnosis;
  diagnosis.verdict = sim::diagnosis::Verdict::supported;
  diagnosis.stages = {{Stage::motor, "flexor"}, {Stage::gearbox, "flexor"}};
  diagnosis.stages[0].judged = diagnosis.stages[1].judged = diagnosis.stages[0].open = true;
  const auto warnings = [&] { return launch::gap::answer_warnings(diagnosis, {}, robot); };
  diagnosis.unexplained = {{Stage::motor, "flexor", 8}};
  CHECK(warnings().empty());
  diagnosis.unexplained = {{Stage::gearbox, "flexor", 8}};
  REQUIRE(warnings().size() == 1);
  CHECK_THAT(warnings()[0], Catch::Contains("opens a gap at the gearbox of flexor"));
  diagnosis.unexplained.clear();
  const auto identified_effect = [](const char* type, const char* on, double value) {
    sim::diagnosis::IdentifiedEffect effect{type, on};
    effect.values = {value};
    return effect;
  };
  diagnosis.answer = {identified_effect("motor_torque_constant", "flexor", 0.005),
                      identified_effect("motor_torque_constant", "extensor", 0.0051)};
  REQUIRE(warnings().size() == 1);
  const std::string time_warning = warnings()[0];
  CHECK_THAT(time_warning, Catch::Contains("time_s running 0.51 % too fast"));
  diagnosis.answer[1].values = {0.009};
  CHECK(warnings().empty());
  CHECK_THAT(time_warning, Catch::Contains("voltages recorded that much too high"));
  diagnosis.answer = {identified_effect("sensor_joint_low_pass", "elbow", 0.01)};
  REQUIRE(warnings().size() == 1);
  CHECK_THAT(warnings()[0], Catch::Contains("delayed by 10 ms"));
  diagnosis.answer = {identified_effect("tendon_damping", "flexor", -12)};
  CHECK(warnings().empty());
  diagnosis.answer[0].alternatives = {
      identified_effect("sensor_tension_low_pass", "flexor", 0.002)};
  REQUIRE(warnings().size() == 1);
  CHECK_THAT(warnings()[0],
             Catch::Contains("a column of flexor that is some ms behind the others"));
  diagnosis.answer.clear();
  for (const char* on : {"flexor", "extensor"}) {
    sim::diagnosis::ConstantEstimate estimate{
        "torque_Nm_per_A", on, Stage::motor, 0.0115, 0.05, 0.01035};
    estimate.interval = {0.0103, 0.0104};
    diagnosis.constants.push_back(estimate);
  }
  REQUIRE(warnings().size() == 1);
  CHECK_THAT(warnings()[0], Catch::Contains("time_s running 10 % too slowly") &&
                                Catch::Contains("voltages recorded that much too low"));
}
