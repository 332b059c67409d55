#include "sim/gap/checks/column_checks.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "sim/gap/residuals/drives.hpp"
#include "tests/sim/gap/residuals/rig_recording.hpp"
#include "tests/sim/rigs.hpp"

using sim::residuals::Episode;
using sim::residuals::Signal;

namespace {

using rigs::hinge_rig;

/// The messages about a recording of the rig after a change of its signals.
template <class Change>
std::vector<std::string> messages_after(Change change) {
  static const Episode unchanged = rig_recording::record(hinge_rig(), hinge_rig(), {.seconds = 8});
  Episode episode = unchanged;
  change(episode);
  return sim::checks::column_checks(episode, hinge_rig());
}

void scale(Signal& signal, double factor) {
  for (double& x : signal) x *= factor;
}

/// Checks that there is one message, that it names this column, and that it contains this text.
void check_reports(const std::vector<std::string>& messages, const char* column, const char* text) {
  REQUIRE(messages.size() == 1);
  CHECK_THAT(messages[0],
             Catch::StartsWith(std::string("run: ") + column) && Catch::Contains(text));
}

/// A recording of a force-controlled slide of 40 kg that moves back and forth.
Episode slide_recording(const erp::Robot& robot) {
  constexpr double row_s = 1e-3, mass_kg = 40, gain_N = 30;
  std::vector<double> control, position, time;
  double x = 0, v = 0;
  for (int k = 0; k < 6000; ++k) {
    const double t = k * row_s, u = 2 * std::sin(5 * t) - 3 * v;
    time.push_back(t), control.push_back(u), position.push_back(x);
    v += (gain_N * u - 4 * std::tanh(v / 1e-4)) / mass_kg * row_s, x += v * row_s;
  }
  recording::Table table;
  table.columns = {{"time_s", time}, {"z.control_V", control}, {"z.position_m", position}};
  std::vector<std::string> remarks;
  return sim::residuals::lay_out(table, sim::residuals::as_chains(robot), "run", remarks);
}

}  // namespace

TEST_CASE("an unchanged recording of the rig gives no message") {
  CHECK(messages_after([](Episode&) {}).empty());
}

TEST_CASE("a column in a wrong unit gives one message with the probable unit") {
  const double degrees = 180 / std::numbers::pi;
  check_reports(messages_after([&](Episode& e) { scale(e.actuators[0].shaft_rad, degrees); }),
                "flexor.shaft_rad", "degrees");
  check_reports(messages_after([&](Episode& e) { scale(e.actuators[0].shaft_rad, 128); }),
                "flexor.shaft_rad", "before the gearbox");
  check_reports(messages_after([&](Episode& e) { scale(e.actuators[0].current_A, 1000); }),
                "flexor.current_A", "thousandths");
  check_reports(messages_after([&](Episode& e) { scale(e.actuators[1].voltage_V, 1000); }),
                "extensor.voltage_V", "thousandths");
  check_reports(messages_after([&](Episode& e) { scale(e.actuators[0].tension_N, 1 / 9.81); }),
                "flexor.tension_N", "kilograms");
  check_reports(messages_after([&](Episode& e) { scale(e.joints[0].angle_rad, degrees); }),
                "elbow.angle_rad", "degrees");
  check_reports(messages_after([](Episode& e) { scale(e.actuators[0].tension_N, 0.01); }),
                "flexor.tension_N", "check its unit");
}

TEST_CASE("a column of wrong sign gives one message that names this column") {
  const auto negated = [](auto signal_of) {
    return messages_after([&](Episode& e) { scale(signal_of(e), -1); });
  };
  for (const std::size_t a : {0U, 1U}) {
    const std::string name = a == 0 ? "flexor" : "extensor";
    check_reports(negated([&](Episode& e) -> Signal& { return e.actuators[a].voltage_V; }),
                  (name + ".voltage_V").c_str(), "multiply the column by -1");
    check_reports(negated([&](Episode& e) -> Signal& { return e.actuators[a].current_A; }),
                  (name + ".current_A").c_str(), "multiply the column by -1");
    check_reports(negated([&](Episode& e) -> Signal& { return e.actuators[a].shaft_rad; }),
                  (name + ".shaft_rad").c_str(), "multiply the column by -1");
    check_reports(negated([&](Episode& e) -> Signal& { return e.actuators[a].tension_N; }),
                  (name + ".tension_N").c_str(), "multiply the column by -1");
  }
}

TEST_CASE("a wrong elbow sign on a symmetric rig gives exchanged muscles as an alternative") {
  const auto messages = messages_after([](Episode& e) { scale(e.joints[0].angle_rad, -1); });
  REQUIRE(messages.size() == 1);
  CHECK_THAT(messages[0], Catch::Contains("elbow.angle_rad has the opposite sign") &&
                              Catch::Contains("; or flexor and extensor seem exchanged in all"));
}

TEST_CASE("two exchanged columns give one message that names both") {
  check_reports(messages_after([](Episode& e) {
                  std::swap(e.actuators[0].tension_N, e.actuators[1].tension_N);
                }),
                "flexor.tension_N and extensor.tension_N", "exchange");
  check_reports(messages_after([](Episode& e) {
                  std::swap(e.actuators[0].shaft_rad, e.actuators[1].shaft_rad);
                }),
                "flexor.shaft_rad and extensor.shaft_rad", "exchange");
  check_reports(messages_after([](Episode& e) {
                  std::swap(e.actuators[1].tension_N, e.actuators[1].current_A);
                }),
                "extensor.current_A and extensor.tension_N", "exchange");
}

TEST_CASE("a wrong sign and a wrong unit in two columns give two messages") {
  const auto messages = messages_after([](Episode& e) {
    scale(e.actuators[0].voltage_V, -1), scale(e.actuators[1].tension_N, 1000);
  });
  REQUIRE(messages.size() == 2);
  CHECK_THAT(messages[0] + messages[1],
             Catch::Contains("flexor.voltage_V") && Catch::Contains("extensor.tension_N"));
}

TEST_CASE("the same wrong unit of both currents gives two messages without alternatives") {
  const auto messages = messages_after([](Episode& e) {
    for (auto& actuator : e.actuators) scale(actuator.current_A, 1000);
  });
  REQUIRE(messages.size() == 2);
  CHECK_THAT(messages[0],
             Catch::Contains("flexor.current_A is 1000 times") && !Catch::Contains("; or "));
  CHECK_THAT(messages[1], Catch::Contains("extensor.current_A is 1000 times"));
}

TEST_CASE("a tension scaled by 0.3 gives no message") {
  CHECK(messages_after([](Episode& e) { scale(e.actuators[0].tension_N, 0.3); }).empty());
}

TEST_CASE("a constant column while others change gives one message that names this column") {
  const auto constant_at = [](auto signal_of, double value) {
    return messages_after([&](Episode& e) { std::ranges::fill(signal_of(e), value); });
  };
  check_reports(constant_at([](Episode& e) -> Signal& { return e.actuators[0].voltage_V; }, 0),
                "flexor.voltage_V is constant at 0 in the whole recording", "is dead");
  check_reports(constant_at([](Episode& e) -> Signal& { return e.actuators[0].current_A; }, 0.1),
                "flexor.current_A is constant at 0.1 in the whole recording", "is dead");
  check_reports(constant_at([](Episode& e) -> Signal& { return e.actuators[1].shaft_rad; }, 0),
                "extensor.shaft_rad", "is dead");
  check_reports(constant_at([](Episode& e) -> Signal& { return e.actuators[1].tension_N; }, 0),
                "extensor.tension_N", "is dead");
  check_reports(constant_at([](Episode& e) -> Signal& { return e.joints[0].angle_rad; }, 0.2),
                "elbow.angle_rad", "is dead");
  check_reports(messages_after([](Episode& e) {
                  auto& current = e.actuators[0].current_A;
                  std::fill(current.begin() + 2000, current.end(), current[2000]);
                }),
                "flexor.current_A", "from 4 s to 8 s");
}

TEST_CASE(
    "with little motion a current that is constant in the whole recording is reported, a current "
    "that is constant from 1 s on is not") {
  const auto constant_from = [](std::size_t first_row) {
    Episode e = rig_recording::record(hinge_rig(), hinge_rig(),
                                      {.seconds = 8, .swing_N = 2, .ripple_N = 1});
    auto& current = e.actuators[0].current_A;
    std::fill(current.begin() + std::ptrdiff_t(first_row), current.end(), 0.1);
    return sim::checks::column_checks(e, hinge_rig());
  };
  check_reports(constant_from(0), "flexor.current_A is constant at 0.1 in the whole recording",
                "is dead");
  CHECK(constant_from(500).empty());
}

TEST_CASE(
    "a tension at the end of its range gives a message about the range, a tension in another unit "
    "only one about the unit") {
  const double range_N = hinge_rig().sensors_of(hinge_rig().actuators[0]).tension_range_N;
  check_reports(messages_after([&](Episode& e) {
                  auto& tension = e.actuators[0].tension_N;
                  std::fill(tension.begin() + 1000, tension.begin() + 1100, range_N);
                }),
                "flexor.tension_N is at the end of its range", "2.5 % of the rows");
  CHECK(messages_after([&](Episode& e) { scale(e.actuators[0].tension_N, 1000); }).size() == 1);
}

TEST_CASE("constant voltage and current of an idle motor give no message") {
  CHECK(messages_after([](Episode& e) {
          std::ranges::fill(e.actuators[0].voltage_V, 0);
          std::ranges::fill(e.actuators[0].current_A, 0);
        }).empty());
}

TEST_CASE(
    "wrong signs, wrong units and a dead encoder of a drive give messages with its column names") {
  erp::Robot robot;
  robot.name = "bench";
  erp::Drive drive;
  drive.name = "z", drive.control = erp::DriveControl::force, drive.gain = 30;
  drive.load = {erp::Slide{{}, 40, 0.01, 1e-6}};
  robot.drives = {drive};
  const auto messages_scaled_by = [&](double factor) {
    Episode e = slide_recording(robot);
    scale(e.actuators[0].shaft_rad, factor);
    return sim::checks::column_checks(e, sim::residuals::as_chains(robot));
  };
  CHECK(messages_scaled_by(1).empty());
  REQUIRE(messages_scaled_by(-1).size() == 1);
  CHECK_THAT(messages_scaled_by(-1)[0],
             Catch::Contains(
                 "z.position_m has the opposite sign of the value expected from z.control_V") &&
                 Catch::Contains("; or "));
  REQUIRE(messages_scaled_by(1000).size() == 1);
  CHECK_THAT(messages_scaled_by(1000)[0],
             Catch::Contains("z.position_m is 1000 times the value expected from z.control_V"));
  REQUIRE(messages_scaled_by(0).size() == 1);
  CHECK_THAT(messages_scaled_by(0)[0],
             Catch::Contains(
                 "z.position_m is constant at 0 in the whole recording while z.control_V changes"));
  Episode constant_command = slide_recording(robot);
  std::ranges::fill(constant_command.actuators[0].current_A, 0.5);
  const auto messages =
      sim::checks::column_checks(constant_command, sim::residuals::as_chains(robot));
  REQUIRE(messages.size() == 1);
  CHECK_THAT(messages[0], Catch::Contains("z.control_V is constant") &&
                              Catch::Contains("while z.position_m changes"));
}
