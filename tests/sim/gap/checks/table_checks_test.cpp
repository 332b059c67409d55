#include "sim/gap/checks/table_checks.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/sim/rigs.hpp"

using sim::checks::table_checks;

namespace {

/// A table of 20 rows with this period and these columns of zeros.
recording::Table table_of(double period_s, const std::vector<std::string>& columns) {
  recording::Table table;
  table.columns.push_back({"time_s", {}});
  for (int k = 0; k < 20; ++k) table.columns[0].values.push_back(period_s * k);
  for (const std::string& name : columns)
    table.columns.push_back({name, std::vector<double>(20, 0.0)});
  return table;
}

std::vector<std::string> messages_about(const recording::Table& table,
                                        const char* robot = "hinge_rig") {
  const std::string file = std::string(robot) + "/robot.xml";
  return table_checks(table, erp::read_robot(rigs::config(file)), "a.csv");
}

}  // namespace

TEST_CASE("columns of the robot's parts with one row per tick give no message") {
  CHECK(messages_about(table_of(0.002, {"flexor.tension_N", "extensor.mode", "elbow.angle_rad"}))
            .empty());
}

TEST_CASE("the columns of a ball joint's sensors give no message") {
  CHECK(
      messages_about(table_of(0.002, {"right_shoulder_x.angle_rad", "right_shoulder.qw"}), "ecce4")
          .empty());
}

TEST_CASE("columns of an unknown part give one message per part with the nearest name") {
  const auto messages =
      messages_about(table_of(0.002, {"flexer.tension_N", "flexer.shaft_rad", "knee.angle_rad"}));
  REQUIRE(messages.size() == 2);
  CHECK(messages[0] ==
        "a.csv: column flexer.tension_N (and 1 more) is ignored: robot \"hinge_rig\" has no part "
        "\"flexer\"; did you mean \"flexor\"?");
  CHECK_THAT(messages[1], Catch::Contains("a.csv: column knee.angle_rad is ignored: ") &&
                              Catch::Contains("elbow"));
}

TEST_CASE("a row period of 4 ms gives a message for ECUs and no message for a drive") {
  const auto messages = messages_about(table_of(0.004, {"flexor.tension_N"}));
  REQUIRE(messages.size() == 1);
  CHECK_THAT(messages[0],
             Catch::Contains("one row per 4 ms") && Catch::Contains("record one row per 2 ms"));
  CHECK(messages_about(table_of(0.004, {"drive.control_V", "drive.position_m"}), "drive").empty());
}

TEST_CASE("a clock error of 2 or 5 % gives a message, a clock error of 0.4 % gives no message") {
  CHECK(messages_about(table_of(0.002008, {"flexor.tension_N"})).empty());
  REQUIRE(messages_about(table_of(0.0021, {"flexor.tension_N"})).size() == 1);
  CHECK_THAT(messages_about(table_of(0.0021, {"flexor.tension_N"}))[0],
             Catch::Contains("5 % too fast"));
  CHECK_THAT(messages_about(table_of(0.00196, {"flexor.tension_N"}))[0],
             Catch::Contains("2 % too slowly"));
  CHECK(messages_about(table_of(0.001, {"flexor.tension_N"})).empty());  // rows between the ticks
}

TEST_CASE("uneven rows give a message, uneven rows with numbered frames give no message") {
  recording::Table table = table_of(0.002, {"flexor.tension_N"});
  for (int k = 0; k < 20; ++k) table.columns[0].values[std::size_t(k)] += 2.8e-4 * std::sin(k * k);
  REQUIRE(messages_about(table).size() == 1);
  CHECK_THAT(messages_about(table)[0], Catch::Contains("ms rms from an even period"));
  table.columns.push_back({"sequence", {}});
  for (int k = 0; k < 20; ++k) table.columns.back().values.push_back(k);
  CHECK(messages_about(table).empty());
}
