#include <catch2/catch.hpp>
#include <sstream>

#include "launch/erp/gap/gap.hpp"
#include "tests/launch/erp/gap/recorded.hpp"

namespace fs = std::filesystem;

TEST_CASE("a recording of 0.12 s is reported as too short and does not change the diagnosis") {
  const RecordedRig folder;
  const auto short_recording = folder.recorded("short.csv", true, 3, 0.12);
  std::ostringstream out, remarks;
  launch::gap::DiagnoseOptions options{.robot = rig_file};
  options.recordings = {folder.recorded("one.csv", true, 1), folder.recorded("two.csv", true, 2),
                        short_recording};
  options.free_run = false, options.out = folder.path / "found";
  CHECK(launch::gap::diagnose(options, out, remarks) == 0);
  CHECK_THAT(out.str(), Catch::Contains("gearbox_coulomb on extensor"));
  CHECK_THAT(remarks.str(),
             Catch::Contains("short.csv: 0.12 s are too short to evaluate any stage"));

  const launch::gap::CalibrateOptions both{
      .robot = rig_file, .out = "", .recordings = {options.recordings[0], short_recording}};
  CHECK(launch::gap::calibrate(both, out, remarks) == 0);
}

TEST_CASE("without a long enough recording, calibrate and confounders return 5") {
  const RecordedRig folder;
  const auto short_recording = folder.recorded("short.csv", true, 3, 0.12);
  std::ostringstream out, remarks;
  CHECK(launch::gap::calibrate({.robot = rig_file, .out = "", .recordings = {short_recording}}, out,
                               remarks) == 5);
  launch::gap::IndistinguishableOptions options;
  options.robot = rig_file, options.recordings = {short_recording};
  CHECK(launch::gap::list_indistinguishable(options, out, remarks) == 5);
  CHECK_THAT(out.str(), Catch::Contains("no stage could be evaluated") &&
                            !Catch::Contains("the sensors distinguish"));
}

TEST_CASE("a copy of a recording is rejected") {
  const RecordedRig folder;
  const auto one = folder.recorded("one.csv", false, 1);
  const auto copy = (folder.path / "copy.csv").string();
  fs::copy_file(one, copy);
  const erp::Robot robot = erp::read_robot(rig_file);
  CHECK_THROWS_WITH(launch::gap::read_episodes(robot, {one, copy}),
                    Catch::Contains("copy.csv: holds the same values as ") &&
                        Catch::Contains("one.csv") && Catch::Contains("remove the copy"));
  CHECK(launch::gap::read_episodes(robot, {one, folder.recorded("two.csv", false, 2)})
            .episodes.size() == 2);
}

TEST_CASE("a tension column wrong by 10 % is located at the tendon, not reported as a bus delay") {
  const RecordedRig folder;
  const auto file = folder.recorded("one.csv", false, 1, 8);
  scale_column(file, "flexor.tension_N", 1.1);
  std::ostringstream out, remarks;
  launch::gap::where(rig_file, {file}, out, remarks);
  CHECK_THAT(out.str(), !Catch::Contains("the bus is late") && Catch::Contains("the gap is in: ") &&
                            Catch::Contains("tendon of flexor"));
}

TEST_CASE("a time column 5 % too fast is reported as suspicious") {
  const RecordedRig folder;
  const auto file = folder.recorded("one.csv", false, 1);
  scale_column(file, "time_s", 1.05);
  const auto suspicious = launch::gap::read_episodes(erp::read_robot(rig_file), {file}).suspicious;
  REQUIRE(suspicious.size() == 1);
  CHECK_THAT(suspicious[0], Catch::Contains("one row per 2.1 ms, but the ECUs' period is 2 ms") &&
                                Catch::Contains("5 % too fast"));
}
