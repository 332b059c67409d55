#include "launch/erp/record/log.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <sstream>

#include "interfaces/recording/mcap_reader.hpp"
#include "launch/erp/record/plot.hpp"
#include "tests/interfaces/recording/support.hpp"
#include "tests/interfaces/recording/tables.hpp"

using namespace launch;

namespace {

/// Captures the output to stderr.
class CapturedStderr {
 public:
  CapturedStderr() : original_buffer_(std::cerr.rdbuf(text_.rdbuf())) {}
  ~CapturedStderr() { std::cerr.rdbuf(original_buffer_); }
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::streambuf* original_buffer_;
};

/// Writes a recording of 4 s: two actuators move a joint back and forth. Frame 30 is missing.
void record_rig(const std::string& path) {
  test::RigFile file(path);
  file.writer.attach("robot.xml", "text/xml", "<robot name=\"rig\"/>");
  std::uint32_t number = 0;
  for (int i = 0; i < 2000; ++i) {
    if (i == 30) continue;
    const double t = i * 0.002,
                 desired_N = t < 1 ? 10 : 25 + 15 * std::sin(2 * M_PI * 0.5 * (t - 1));
    const double tension_N =
        desired_N * (t < 1 ? 1 - std::exp(-t / 0.1) : 1) + 0.2 * std::sin(300 * t);
    const auto stamp = static_cast<std::int64_t>(i) * 2'000'000;
    number = static_cast<std::uint32_t>(i);
    const auto bytes = test::frame(stamp, number,
                                   {{.name = "flexor",
                                     .reference = desired_N,
                                     .line_m = -0.002 * tension_N / 10,
                                     .tension_N = tension_N},
                                    {.name = "extensor",
                                     .mode = 2,
                                     .reference = 0.001,
                                     .line_m = 0.001 + 1e-5 * std::sin(40 * t),
                                     .tension_N = 12 - 0.1 * tension_N}},
                                   {{.name = "elbow", .angle_rad = 0.02 * tension_N}});
    file.writer.write(file.frames, number, static_cast<std::uint64_t>(stamp),
                      static_cast<std::uint64_t>(stamp), bytes);
    file.write(file.joints, static_cast<std::uint64_t>(stamp),
               test::ball(stamp, "shoulder", std::cos(0.3 * t / 2)));
  }
}

}  // namespace

TEST_CASE("info prints duration, topics, rates, missing messages and attachments") {
  const test::Folder folder;
  record_rig(folder / "a.mcap");
  std::ostringstream out;
  CHECK(log_info(folder / "a.mcap", out) == 0);
  CHECK_THAT(out.str(), Catch::Contains("a.mcap: complete, 3.998 s, 3998 messages in "));
  CHECK_THAT(out.str(),
             Catch::Matches(
                 "(.|\n)*sensor_frame +erp/msg/SensorFrame +1999 +499\\.7 Hz +1 +0 +1\n(.|\n)*"));
  CHECK_THAT(out.str(), Catch::Contains("robot.xml   text/xml    19 B"));
}

TEST_CASE("info on a truncated recording prints the position and the command that recovers it") {
  const test::Folder folder;
  record_rig(folder / "a.mcap");
  const std::string bytes = test::read_file(folder / "a.mcap");
  test::write_file(folder / "cut.mcap", bytes.substr(0, bytes.size() / 2));
  std::ostringstream out, printed;
  CHECK(log_info(folder / "cut.mcap", out) == 0);
  CHECK_THAT(out.str(), Catch::Contains("cut off") && Catch::Contains("erp log recover"));
  CHECK(log_recover(folder / "cut.mcap", folder / "whole.mcap", printed) == 0);
  CHECK_THAT(printed.str(),
             Catch::Contains("the file ends inside") && Catch::Contains("1 attachments"));
  CHECK(recording::McapReader(folder / "whole.mcap").complete());
}

TEST_CASE("export writes the table or any topic; two exports of a recording are equal") {
  const test::Folder folder;
  record_rig(folder / "a.mcap");
  std::ostringstream first, second, topic;
  CHECK(log_export(folder / "a.mcap", first) == 0);
  CHECK(log_export(folder / "a.mcap", second) == 0);
  CHECK(first.str() == second.str());
  CHECK(first.str().starts_with("time_s,flexor.mode,"));
  test::write_file(folder / "a.csv", first.str());
  std::ostringstream second_export;
  CHECK(log_export(folder / "a.csv", second_export) == 0);
  CHECK(second_export.str() == first.str());
  CHECK(log_export(folder / "a.mcap", topic, {.topic = "joint_state"}) == 0);
  CHECK(
      topic.str().starts_with("log_time_ns,robot,source,stamp_ns,sequence,joints.shoulder.dof,"
                              "joints.shoulder.position[0],"));
  CHECK_THAT(topic.str(), Catch::Contains("\n2000000,rig,sim,2000000,0,3,0.9999"));
}

TEST_CASE("invalid input gives exit code 2 and an error on stderr, a full disk gives exit code 1") {
  const test::Folder folder;
  record_rig(folder / "a.mcap");
  std::ostringstream out;
  const CapturedStderr errors;
  CHECK(log_info(folder / "missing.mcap", out) == 2);
  CHECK(log_export(folder / "a.mcap", out, {.topic = "nothing"}) == 2);
  CHECK_THAT(errors.text(),
             Catch::Contains("no topic \"nothing\"; recorded topics: actuator_command, "));
  CHECK(log_recover(folder / "a.mcap", folder / "a.mcap", out) == 2);
  CHECK(log_plot(folder / "a.mcap", folder / "a.gif") == 2);
  CHECK_THAT(errors.text(), Catch::Contains("a.gif: can draw .svg and .png only"));
  CHECK(log_plot(folder / "a.mcap", folder / "a.svg", {.signals = {"knee"}}) == 2);
  CHECK_THAT(errors.text(), Catch::Contains("no signal \"knee\"; there are flexor.tension_N, "));
  CHECK_THROWS_AS(log_plot(folder / "a.mcap", folder / "no/such/folder/a.svg"),
                  std::invalid_argument);
  std::ofstream full("/dev/full");
  CHECK(log_export(folder / "a.mcap", full) == 1);
  CHECK(log_recover(folder / "a.mcap", folder / "no/such/folder/b.mcap", out) == 1);
}

TEST_CASE("plot draws an SVG and a PNG with one panel per signal") {
  const test::Folder folder;
  record_rig(folder / "a.mcap");
  REQUIRE(log_plot(folder / "a.mcap", folder / "a.svg") == 0);
  const std::string svg = test::read_file(folder / "a.svg");
  for (const char* word :
       {"tension  [N]", "line length  [mm]", "joint angle  [°]", "joint rotation  [°]", "flexor",
        "elbow", "desired", "time  [s]", "a.mcap"})
    CHECK_THAT(svg, Catch::Contains(word));
  REQUIRE(log_plot(folder / "a.mcap", folder / "a.png", {.title = "The rig's \"first\" light"}) ==
          0);
  CHECK(test::read_file(folder / "a.png").starts_with("\x89PNG"));
  CHECK_FALSE(std::filesystem::exists(folder / "a.png.part"));
}

TEST_CASE("actuator names with shell or gnuplot commands are drawn and not executed") {
  const test::Folder folder;
  const std::string hostile_name = "'`touch " + folder / "pwned" + "`\"\nquit\n";
  recording::Table table{{{"time_s", {0, 1}}, {hostile_name + ".tension_N", {1, 2}}}};
  draw(plot_script(table, {}, hostile_name, "t"), folder / "a.svg");
  CHECK_FALSE(std::filesystem::exists(folder / "pwned"));
  CHECK_THAT(test::read_file(folder / "a.svg"), Catch::Contains("tension  [N]"));
}

TEST_CASE("without gnuplot, plot prints the package to install and leaves no files") {
  const test::Folder folder;
  record_rig(folder / "a.mcap");
  const std::string path = std::getenv("PATH");
  setenv("PATH", (folder / "").c_str(), 1);
  const CapturedStderr errors;
  CHECK(log_plot(folder / "a.mcap", folder / "a.svg") == 2);
  setenv("PATH", path.c_str(), 1);
  CHECK_THAT(errors.text(),
             Catch::Contains("cannot run gnuplot") && Catch::Contains("gnuplot-nox"));
  CHECK_FALSE(std::filesystem::exists(folder / "a.svg.part"));
}

TEST_CASE(
    "a long curve keeps its peaks when it is decimated; it is interrupted where samples are "
    "missing") {
  recording::Table table{{{"time_s", {}}, {"m.tension_N", {}}}};
  for (int i = 0; i < 100000; ++i) {
    table.columns[0].values.push_back(i * 0.001);
    const bool is_missing = i > 50000 && i < 60000;
    table.columns[1].values.push_back(is_missing ? recording::not_taken : i == 77777 ? 99.5 : 1.0);
  }
  const std::string commands = plot_script(table, {}, "t", "t").commands;
  CHECK_THAT(commands, Catch::Contains("77.777 99.5\n"));
  CHECK_THAT(commands, Catch::Contains(" 1\n\n"));
  CHECK(std::count(commands.begin(), commands.end(), '\n') < 2100);
}
