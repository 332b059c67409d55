#include "sim/gap/residuals/episode.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "sim/gap/residuals/bump.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::residuals;

namespace {

recording::Table sine(int rows) {
  recording::Table table{{{"time_s", {}}, {"flexor.shaft_rad", {}}, {"flexor.voltage_V", {}}}};
  for (int k = 0; k < rows; ++k) {
    table.columns[0].values.push_back(0.002 * k);
    table.columns[1].values.push_back(std::sin(0.02 * k));
    table.columns[2].values.push_back(k % 50 < 25 ? 6 : -6);
  }
  return table;
}

using rigs::hinge_rig;

}  // namespace

TEST_CASE(
    "repeated rows are dropped, two missing rows are interpolated, twenty missing rows are NaN") {
  recording::Table table = sine(1000);
  for (auto& column : table.columns) {
    column.values.insert(column.values.begin() + 101, column.values[100]);  // repeated row
    column.values.erase(column.values.begin() + 301, column.values.begin() + 303);
    column.values.erase(column.values.begin() + 500, column.values.begin() + 520);
  }
  std::vector<std::string> remarks;
  const Episode episode = lay_out(table, hinge_rig(), "run.csv", remarks);
  CHECK(episode.rows == 1000);
  CHECK(episode.period_s == Approx(0.002));
  const Signal& shaft = episode.actuators[0].shaft_rad;
  CHECK(shaft[301] == Approx(std::sin(0.02 * 301)).margin(1e-3));
  CHECK(std::isnan(shaft[510]));
  CHECK(shaft[999] == Approx(std::sin(0.02 * 999)));
  CHECK(episode.actuators[0].current_A.empty());
  CHECK(episode.actuators[1].shaft_rad.empty());
  REQUIRE(remarks.size() == 2);
  CHECK(remarks[0] == "run.csv: 1 row repeats a time; dropped");
  CHECK(remarks[1] == "run.csv: 22 rows are missing");
}

TEST_CASE("a time in ms, µs or ns is rejected with the divisor to use") {
  for (const auto& [in_a_second, unit] : {std::pair{1e3, "milliseconds, divide them by 1000"},
                                          {1e6, "microseconds, divide them by 1000000"},
                                          {1e9, "nanoseconds, divide them by 1000000000"}}) {
    recording::Table table = sine(100);
    for (double& time : table.columns[0].values) time *= in_a_second;
    std::vector<std::string> remarks;
    CHECK_THROWS_WITH(lay_out(table, hinge_rig(), "run.csv", remarks),
                      Catch::StartsWith("run.csv: time_s: rows ") && Catch::EndsWith(unit));
  }
}

TEST_CASE("sign flips of a quaternion are removed, and its short gaps are interpolated") {
  const erp::Robot robot = erp::read_robot(rigs::config("arm/robot.xml"));
  const auto joints = robot.joints();
  const auto ball =
      std::ranges::find(joints, erp::JointType::spherical, [](const auto& j) { return j.type; });
  recording::Table table{{{"time_s", {}}}};
  for (const char* part : {".qw", ".qx", ".qy", ".qz"})
    table.columns.push_back({ball->name + part, Signal(100, 0.0)});
  for (std::size_t k = 0; k < 100; ++k) {
    const double sign = k < 50 ? 1 : -1, half_rad = 0.002 * double(k);
    table.columns[0].values.push_back(0.002 * double(k));
    table.columns[1].values[k] = sign * std::cos(half_rad);
    table.columns[2].values[k] = sign * std::sin(half_rad);
  }
  for (std::size_t c = 1; c < 5; ++c)
    for (const std::size_t k : {49, 50, 51}) table.columns[c].values[k] = recording::not_taken;
  std::vector<std::string> remarks;
  const Episode episode = lay_out(table, robot, "x", remarks);
  const auto& q = episode.joints[std::size_t(ball - joints.begin())].quaternion;
  for (std::size_t k = 0; k < 100; ++k) {
    CHECK(q[0][k] == Approx(std::cos(0.002 * double(k))).margin(1e-4));
    CHECK(q[1][k] == Approx(std::sin(0.002 * double(k))).margin(1e-4));
  }
}

TEST_CASE(
    "jittered times are rejected without numbered frames and replaced by ticks with numbered "
    "frames") {
  recording::Table table = sine(1000);
  Signal ticks;
  for (std::size_t k = 0; k < 1000; ++k) {
    ticks.push_back(static_cast<double>(7 + k));
    if (k % 10 == 5) table.columns[0].values[k] += 0.0015;  // 0.5 ms before the next row
  }
  std::vector<std::string> remarks;
  CHECK_THROWS_WITH(lay_out(table, hinge_rig(), "x", remarks),
                    Catch::Contains("of arrival"));
  table.columns.push_back({"sequence", ticks});
  const Episode episode = lay_out(table, hinge_rig(), "x", remarks);
  CHECK(episode.rows == 1000);
  CHECK(episode.period_s == Approx(0.002).epsilon(1e-9));
  CHECK(episode.actuators[0].shaft_rad == table.columns[1].values);
  CHECK(remarks.empty());
}

TEST_CASE("a jitter of a third of a period neither drops nor repeats a row") {
  recording::Table table = sine(4000);
  for (std::size_t k = 0; k < 4000; ++k)
    table.columns[0].values[k] += 7e-4 * std::sin(double(k * k));  // a third of a period
  std::vector<std::string> remarks;
  const Episode episode = lay_out(table, hinge_rig(), "run.csv", remarks);
  CHECK(remarks.empty());
  CHECK(episode.rows == 4000);
  CHECK(episode.actuators[0].shaft_rad == table.columns[1].values);
}

TEST_CASE("an outlier of a shaft angle is dropped, a jump of a voltage is not") {
  recording::Table table = sine(1000);
  table.columns[1].values[400] += 3;
  std::vector<std::string> remarks;
  const Episode episode = lay_out(table, hinge_rig(), "run.csv", remarks);
  CHECK(episode.actuators[0].shaft_rad[400] == Approx(std::sin(8.0)).margin(1e-3));
  CHECK(episode.actuators[0].voltage_V == table.columns[2].values);
  REQUIRE(remarks.size() == 1);
  CHECK(remarks[0] == "run.csv: flexor.shaft_rad: 1 outlier dropped");
}

TEST_CASE("a recording with mostly repeated times is rejected with the reason") {
  recording::Table table = sine(1000);
  for (double& t : table.columns[0].values) t = std::round(100 * t) / 100;
  std::vector<std::string> remarks;
  CHECK_THROWS_WITH(lay_out(table, hinge_rig(), "run.csv", remarks),
                    Catch::Contains("run.csv: time_s: most rows have the time of the row before"));
}

TEST_CASE("columns of another robot and a gap of minutes are rejected with the reason") {
  std::vector<std::string> remarks;
  recording::Table other{
      {{"time_s", sine(100).columns[0].values}, {"knee.current_A", Signal(100)}}};
  CHECK_THROWS_WITH(lay_out(other, hinge_rig(), "x", remarks),
                    Catch::Contains("no column of robot \"hinge_rig\""));
  recording::Table gap = sine(100);
  for (std::size_t k = 50; k < 100; ++k) gap.columns[0].values[k] += 100;
  CHECK_THROWS_WITH(lay_out(gap, hinge_rig(), "x", remarks), Catch::Contains("no rows for"));
}

TEST_CASE("a window gives the mean, rate and acceleration of a parabola exactly") {
  const Bump bump(0.03, 0.002);
  Signal x;
  for (int k = 0; k < 40; ++k) x.push_back(3 + 2 * (0.002 * k) + 5 * (0.002 * k) * (0.002 * k));
  CHECK(bump.rate(x, 20) == Approx(2 + 10 * 0.04));
  CHECK(bump.acceleration(x, 20) == Approx(10));
  CHECK(bump.mean(Signal(40, 7.0), 20) == Approx(7));
  CHECK(bump.acceleration(Signal(40, 7.0), 20) == Approx(0).margin(1e-9));
}
