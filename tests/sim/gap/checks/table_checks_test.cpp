#include "sim/gap/checks/table_checks.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/sim/rigs.hpp"

using sim::checks::table_checks;

namespace {

/// Rows so far apart, of these columns.
recording::Table table_of(double period_s, const std::vector<std::string>& columns) {
  recording::Table table;
  table.columns.push_back({"time_s", {}});
  for (int k = 0; k < 20; ++k) table.columns[0].values.push_back(period_s * k);
  for (const std::string& name : columns)
    table.columns.push_back({name, std::vector<double>(20, 0.0)});
  return table;
}

std::vector<std::string> suspicious(const recording::Table& table,
                                    const char* robot = "hinge_rig") {
  const std::string file = std::string(robot) + "/robot.xml";
  return table_checks(table, erp::read_robot(rigs::config(file)), "a.csv");
}

}  // namespace

TEST_CASE("columns of the robot's parts, a row each tick, are not odd") {
  CHECK(suspicious(table_of(0.002, {"flexor.tension_N", "extensor.mode", "elbow.angle_rad"}))
            .empty());
}

TEST_CASE("the three readings of a ball joint are its own") {
  CHECK(suspicious(table_of(0.002, {"right_shoulder_x.angle_rad", "right_shoulder.qw"}), "ecce4")
            .empty());
}

TEST_CASE("columns of nobody are told, once for each name, with whom they may be meant to be of") {
  const auto said =
      suspicious(table_of(0.002, {"flexer.tension_N", "flexer.shaft_rad", "knee.angle_rad"}));
  REQUIRE(said.size() == 2);
  CHECK(said[0] ==
        "a.csv: flexer.tension_N and 1 more: robot \"hinge_rig\" has no \"flexer\": did "
        "you mean \"flexor\"?");
  CHECK_THAT(said[1], Catch::Contains("a.csv: knee.angle_rad: ") && Catch::Contains("elbow"));
}

TEST_CASE("rows further apart than the ECUs' ticks are told, of a drive, which has none, not") {
  const auto said = suspicious(table_of(0.004, {"flexor.tension_N"}));
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0],
             Catch::Contains("a row each 4 ms") && Catch::Contains("record one each 2 ms"));
  CHECK(suspicious(table_of(0.004, {"drive.control_V", "drive.position_m"}), "drive").empty());
}

TEST_CASE("rows by a clock that runs by more than half a percent too fast or slowly are told") {
  CHECK(suspicious(table_of(0.002008, {"flexor.tension_N"})).empty());
  REQUIRE(suspicious(table_of(0.0021, {"flexor.tension_N"})).size() == 1);
  CHECK_THAT(suspicious(table_of(0.0021, {"flexor.tension_N"}))[0],
             Catch::Contains("5 % too fast"));
  CHECK_THAT(suspicious(table_of(0.00196, {"flexor.tension_N"}))[0],
             Catch::Contains("2 % too slowly"));
  CHECK(suspicious(table_of(0.001, {"flexor.tension_N"})).empty());  // rows between the ticks
}

TEST_CASE("rows that come early and late are told, those whose frames are numbered not") {
  recording::Table table = table_of(0.002, {"flexor.tension_N"});
  for (int k = 0; k < 20; ++k) table.columns[0].values[std::size_t(k)] += 2.8e-4 * std::sin(k * k);
  REQUIRE(suspicious(table).size() == 1);
  CHECK_THAT(suspicious(table)[0], Catch::Contains("ms rms before and after an even"));
  table.columns.push_back({"sequence", {}});
  for (int k = 0; k < 20; ++k) table.columns.back().values.push_back(k);
  CHECK(suspicious(table).empty());
}
