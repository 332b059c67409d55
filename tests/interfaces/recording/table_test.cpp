#include "interfaces/recording/table.hpp"

#include <bit>
#include <catch2/catch.hpp>
#include <limits>
#include <random>
#include <sstream>

#include "interfaces/recording/csv.hpp"
#include "interfaces/recording/error.hpp"
#include "tests/interfaces/recording/support.hpp"
#include "tests/interfaces/recording/tables.hpp"

using namespace recording;

namespace {

std::string csv_of(const Table& table) {
  std::ostringstream out;
  write_csv(table, out);
  return out.str();
}
std::string csv_of(const std::string& path, const TableOptions& options = {}) {
  return csv_of(read_table(path, options));
}

}  // namespace

TEST_CASE("each sensor frame gives one row; a measurement that was not taken gives an empty cell") {
  const test::Folder folder;
  {
    test::RigFile file(folder / "a.mcap");
    file.write(file.frames, 50,
               test::frame(5'000'000'000, 0,
                           {{.name = "flexor",
                             .reference = 40,
                             .voltage_V = 1.5,
                             .current_A = 0.2,
                             .shaft_rad = 0.1,
                             .line_m = -1,
                             .tension_N = 39.5}},
                           {{.name = "elbow", .angle_rad = 0.25}}));
    file.write(file.frames, 60,
               test::frame(5'002'000'000, 1,
                           {{.name = "flexor",
                             .valid = 17,
                             .mode = 1,
                             .reference = -2,
                             .voltage_V = -2,
                             .current_A = 9,
                             .tension_N = 0.1}},
                           {{.name = "elbow", .valid = 0, .angle_rad = 9}}));
    file.write(file.frames, 70,
               test::frame(5'004'000'000, 2,
                           {{.name = "flexor", .valid = 0, .mode = 0, .reference = 7}}, {}));
  }
  CHECK(csv_of(folder / "a.mcap") ==
        "time_s,flexor.mode,flexor.reference,flexor.voltage_V,flexor.current_A,flexor.shaft_rad,"
        "flexor.tension_N,elbow.angle_rad\n"
        "0,force,40,1.5,0.2,0.1,39.5,0.25\n"
        "0.002,voltage,-2,-2,,,0.1,\n"
        "0.004,,,,,,,\n");
}

TEST_CASE("rows are in the order of stamps, not in the order of arrival") {
  const test::Folder folder;
  {
    test::RigFile file(folder / "a.mcap");
    file.write(file.frames, 1, test::frame(3'000, 2, {}, {{.name = "j", .angle_rad = 3}}));
    file.write(file.frames, 2, test::frame(1'000, 0, {}, {{.name = "j", .angle_rad = 1}}));
    file.write(file.frames, 3, test::frame(2'000, 1, {}, {{.name = "j", .angle_rad = 2}}));
  }
  CHECK(csv_of(folder / "a.mcap") == "time_s,j.angle_rad\n0,1\n1e-06,2\n2e-06,3\n");
}

TEST_CASE("an actuator that is missing in the first frames has empty cells there") {
  const test::Folder folder;
  {
    test::RigFile file(folder / "a.mcap");
    file.write(file.frames, 1, test::frame(0, 0, {}, {{.name = "j", .angle_rad = 1}}));
    file.write(file.frames, 2,
               test::frame(1'000'000'000, 1, {{.name = "m", .mode = 4, .reference = 2}}, {}));
  }
  CHECK(csv_of(folder / "a.mcap") ==
        "time_s,m.mode,m.reference,m.voltage_V,m.current_A,m.shaft_rad,m.tension_N,j.angle_rad\n"
        "0,,,,,,,1\n1,force,2,0,0,0,0,\n");
}

TEST_CASE(
    "a spherical joint without a sensor is read from joint_state; each of its samples is used at "
    "most once") {
  const test::Folder folder;
  {
    test::RigFile file(folder / "a.mcap");
    file.write(file.joints, 1,
               test::ball(90, "shoulder", 0.9));  // before the first frame: not used
    for (const std::int64_t t : {100, 200, 300})
      file.write(file.frames, 2, test::frame(t, 0, {}, {{.name = "elbow", .angle_rad = 1}}));
    file.write(file.joints, 3, test::ball(100, "shoulder", 0.1));
    file.write(file.joints, 3, test::ball(150, "shoulder", 0.15));
    file.write(file.joints, 3, test::ball(190, "shoulder", 0.19));
    file.write(file.joints, 4, test::ball(200, "elbow", 0.5));
  }
  CHECK(csv_of(folder / "a.mcap") ==
        "time_s,elbow.angle_rad,shoulder.qw,shoulder.qx,shoulder.qy,shoulder.qz\n"
        "0,1,0.1,0,0,0\n1e-07,1,0.19,0,0,0\n2e-07,1,,,,\n");
}

TEST_CASE("motion capture is preferred to the simulator unless a source is given") {
  const test::Folder folder;
  {
    test::RigFile file(folder / "a.mcap");
    file.write(file.frames, 2, test::frame(100, 0, {}, {}));
    file.write(file.joints, 3, test::ball(100, "s", 0.1));
    file.write(file.joints, 3, test::ball(100, "s", 0.2, "motion_capture"));
    file.write(file.joints, 3, test::ball(100, "s", 0.3, "pose_estimator"));
  }
  CHECK(read_table(folder / "a.mcap").find("s.qw")->values[0] == 0.2);
  CHECK(read_table(folder / "a.mcap", {.pose_source = "sim"}).find("s.qw")->values[0] == 0.1);
  CHECK(read_table(folder / "a.mcap", {.pose_source = "nobody"}).find("s.qw") == nullptr);
}

TEST_CASE("a target is in the row that it answers; a command is not a target") {
  const test::Folder folder;
  {
    test::RigFile file(folder / "a.mcap");
    for (std::uint64_t i = 0; i < 4; ++i)
      file.write(file.frames, 10 * i,
                 test::frame(static_cast<std::int64_t>(i), i, {{.name = "m"}}, {}));
    file.write(file.commands, 5, test::target(1, "m", 1, 9.0, true, 100));
    file.write(file.targets, 6, test::target(1, "m", 4, 20.0));
    file.write(file.targets, 9, test::target(77, "m", 4, 1.0));
    file.write(file.targets, 9, test::target(0, "stranger", 4, 1.0));
  }
  const Table table = read_table(folder / "a.mcap", {.lines = true, .targets = true});
  std::string text;
  for (const double x : table.find("m.target")->values) text += csv_number(x) + "|";
  CHECK(text == "|20|||");
  CHECK(table.find("m.target_mode")->values[1] == 4);
  CHECK(table.find("m.line_m") != nullptr);
  CHECK(table.find("stranger.target") == nullptr);
  CHECK(read_table(folder / "a.mcap").find("m.target") == nullptr);
}

TEST_CASE(
    "a recording of two robots is rejected without the name of a robot; a recording without frames "
    "is rejected") {
  const test::Folder folder;
  {
    test::RigFile file(folder / "a.mcap");
    file.write(file.frames, 1, test::frame(0, 0, {}, {{.name = "j", .angle_rad = 1}}, "left"));
    file.write(file.frames, 1, test::frame(0, 0, {}, {{.name = "j", .angle_rad = 2}}, "right"));
  }
  CHECK_THROWS_WITH(read_table(folder / "a.mcap"),
                    Catch::Contains("contains the robots left and right"));
  CHECK(read_table(folder / "a.mcap", {.robot = "right"}).find("j.angle_rad")->values ==
        std::vector<double>{2});
  CHECK_THROWS_WITH(read_table(folder / "a.mcap", {.robot = "up"}),
                    Catch::Contains("no sensor_frame of robot \"up\""));
  { test::RigFile empty(folder / "empty.mcap"); }
  CHECK_THROWS_WITH(read_table(folder / "empty.mcap"),
                    Catch::Contains("no sensor_frame; list its contents"));
}

TEST_CASE("a table written as CSV is read back bit-equal and written to the same bytes") {
  std::mt19937_64 random(11);
  Table table{
      {{"time_s", {}}, {"m.mode", {}}, {"m.tension_N", {}}, {"odd, \"name\".angle_rad", {}}}};
  const double special_values[] = {0.0,
                                   -0.0,
                                   5e-324,
                                   1e308,
                                   0.1,
                                   1.0 / 3,
                                   123456789012345678.0,
                                   -1e-7,
                                   std::numeric_limits<double>::infinity(),
                                   not_taken};
  for (int i = 0; i < 2000; ++i) {
    double x = std::bit_cast<double>(random());
    if (std::isnan(x)) x = not_taken;
    if (i < 10) x = special_values[i];
    table.columns[0].values.push_back(i * 0.002);
    table.columns[1].values.push_back(i % 5 == 4 ? not_taken : 1 + i % 4);
    table.columns[2].values.push_back(x);
    table.columns[3].values.push_back(-x);
  }
  const std::string text = csv_of(table);
  const Table read_back = parse_csv("t.csv", text);
  REQUIRE(read_back.columns.size() == table.columns.size());
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    CHECK(read_back.columns[c].name == table.columns[c].name);
    for (std::size_t r = 0; r < table.rows(); ++r) {
      const double a = table.columns[c].values[r], b = read_back.columns[c].values[r];
      if (std::isnan(a) ? !std::isnan(b)
                        : std::bit_cast<std::uint64_t>(a) != std::bit_cast<std::uint64_t>(b))
        FAIL("column " << c << " row " << r << ": " << a << " became " << b);
    }
  }
  CHECK(csv_of(read_back) == text);
}

TEST_CASE(
    "a CSV of another program with other order, quotes, blanks, line ends and missing columns is "
    "read") {
  const Table table = parse_csv("t.csv",
                                "\xEF\xBB\xBF\"flexor.tension_N\" , time_s,flexor.mode\r\n "
                                "1e1,+0.0,force\r\n\r\n,0.5,\r\nnan,1,off\r\n");
  REQUIRE(table.columns.size() == 3);
  CHECK(table.columns[0].name == "time_s");
  CHECK(table.columns[1].name == "flexor.tension_N");
  CHECK(table.columns[0].values == std::vector<double>{0, 0.5, 1});
  CHECK(table.columns[1].values[0] == 10);
  CHECK(std::isnan(table.columns[1].values[1]));
  CHECK(std::isnan(table.columns[1].values[2]));
  CHECK(table.columns[2].values[0] == 4);
  CHECK(table.owners("tension_N") == std::vector<std::string>{"flexor"});
}

TEST_CASE("an error in a CSV is rejected with file, line, column, value and remedy") {
  const auto check_rejected = [](const std::string& text, const std::string& message) {
    CHECK_THROWS_WITH(parse_csv("t.csv", text),
                      Catch::StartsWith("t.csv:") && Catch::Contains(message));
  };
  check_rejected("", ":1:1: there is no column time_s");
  check_rejected("time_s;m.mode\n", "separate them by commas");
  check_rejected("time_ms,m.tension_N\n",
                 ":1:1: unknown column \"time_ms\"; name it time_s, in seconds");
  check_rejected("time_s,m.tension\n",
                 ":1:8: unknown column \"m.tension\"; did you mean \"m.tension_N\"?");
  check_rejected("time_s,m.force_N\n",
                 ":1:8: unknown column \"m.force_N\"; valid names: m.mode, m.reference");
  check_rejected("time_s,tension_N\n",
                 ":1:8: unknown column \"tension_N\"; name it <actuator or joint>.");
  check_rejected("time_s,m.mode,m.mode\n", ":1:15: column \"m.mode\" occurs twice");
  check_rejected("time_s,m.mode\n0,fast\n", ":2:3: unknown mode \"fast\"; use off, voltage");
  check_rejected("time_s,m.tension_N\n0,1\n1,1x\n", ":3:3: \"1x\" is not a number");
  check_rejected("time_s,m.tension_N\n0,1,5\n", ":2:5: the row has 3 cells, the header 2");
  check_rejected("time_s,m.tension_N\n0\n", ":2:1: the row has 1 cells");
  check_rejected("time_s,m.tension_N\n0,1e999\n", "beyond what a double holds");
  check_rejected("time_s,m.tension_N\n1,0\n0.5,0\n",
                 ":3:1: time_s steps back to 0.5; two recordings in one");
  check_rejected("time_s,m.tension_N\n,0\n", ":2:1: time_s is empty");
  check_rejected("m.tension_N,time_s\n0,1\n0,0\n", ":3:3: time_s steps back");
  check_rejected("time_s,\"m.mode\n0,1\n", "a quoted cell is not closed");
}

TEST_CASE("CSV and MCAP are distinguished by their first bytes") {
  const test::Folder folder;
  test::write_file(folder / "a.data", "time_s,j.angle_rad\n0,1\n");
  CHECK(csv_of(folder / "a.data") == "time_s,j.angle_rad\n0,1\n");
  test::write_file(folder / "b.data", "{}");
  std::ofstream(folder / "robot.xml") << "<?xml version=\"1.0\"?><robot/>";
  CHECK_THROWS_WITH(read_table(folder / "robot.xml"),
                    Catch::Contains("this is XML, not a recording"));
  CHECK_THROWS_WITH(read_table(folder / "b.data"), Catch::Contains("b.data:1:1:"));
}
