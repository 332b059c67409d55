#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "interfaces/recording/csv.hpp"
#include "launch/erp/gap/gap.hpp"
#include "sim/model/effects/library.hpp"
#include "tests/sim/gap/residuals/rig_recording.hpp"
#include "tests/sim/rigs.hpp"

namespace fs = std::filesystem;

namespace {

/// Writes a recording of the rig without a gap, and a model with a tolerance.
struct CalibrationFolder {
  fs::path path = fs::temp_directory_path() / ("erp_calibrate_" + std::to_string(::getpid()));
  CalibrationFolder() { fs::create_directories(path); }
  ~CalibrationFolder() { fs::remove_all(path); }

  std::string recorded() const {
    std::ofstream out(path / "one.csv");
    recording::write_csv(rig_recording::table_of_run(
                             erp::read_robot(rigs::config("hinge_rig/robot.xml")), {.seconds = 5}),
                         out);
    return path / "one.csv";
  }
  std::string model_with(const erp::Tolerance& tolerance) const {
    erp::Robot robot = erp::read_robot(rigs::config("hinge_rig/robot.xml"));
    robot.tolerances = {tolerance};
    std::ofstream(path / "robot.xml") << erp::write_robot(robot);
    return path / "robot.xml";
  }
};

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Output of `erp gap …`, run by mpirun with this number of processes, one thread each.
std::string printed(int processes, const std::string& verb, const fs::path& folder) {
  const std::string file = folder / ("printed_" + std::to_string(processes));
  const std::string run =
      "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 timeout 300 mpirun "
      "--oversubscribe -n " +
      std::to_string(processes) + " " ERP_BIN_DIR "/erp gap " + verb + " --threads 1 > " + file +
      " 2> " + file + ".remarks";
  const int code = std::system(run.c_str());
  INFO(text_of(file + ".remarks"));
  CHECK(WIFEXITED(code));
  return text_of(file);
}

erp::Tolerance tolerance(const char* constant, double relative) {
  erp::Tolerance tolerance;
  tolerance.of = constant, tolerance.on = "forearm", tolerance.relative = relative;
  return tolerance;
}

std::string calibrated(const std::string& robot, const std::string& recording) {
  std::ostringstream out, remarks;
  launch::gap::calibrate({.robot = robot, .recordings = {recording}}, out, remarks);
  return out.str();
}

}  // namespace

TEST_CASE(
    "a constant with a tolerance of 0 is not estimated; a written robot keeps its tolerances") {
  const CalibrationFolder folder;
  const auto recording = folder.recorded();
  const auto exact = calibrated(folder.model_with(tolerance("mass", 0)), recording);
  CHECK(exact.find(" mass ") == std::string::npos);
  CHECK(exact.find(" com ") != std::string::npos);
  const auto free = calibrated(folder.model_with(tolerance("mass", 0.1)), recording);
  CHECK(free.find(" mass ") != std::string::npos);
  const erp::Robot again = erp::read_robot(folder.path / "robot.xml");
  REQUIRE(again.tolerances.size() == 1);
  CHECK(again.tolerances[0].relative == 0.1);
}

TEST_CASE("a calibrated robot.xml has one motor type per actuator and can be calibrated again") {
  const CalibrationFolder folder;
  const auto recording = folder.recorded();
  const std::string built = folder.path / "built.xml";
  std::ostringstream out, remarks;
  launch::gap::calibrate(
      {.robot = folder.model_with(tolerance("mass", 0.1)), .out = built, .recordings = {recording}},
      out, remarks);
  const erp::Robot robot = erp::read_robot(built);
  CHECK(robot.actuators[0].motor == "caliper_12V_of_flexor");
  CHECK(robot.actuators[1].motor == "caliper_12V_of_extensor");
  const std::string again = calibrated(built, recording);
  CHECK_THAT(again, Catch::Contains(" resistance_ohm "));
  CHECK_THAT(again, !Catch::Contains("beyond its tolerance"));
}

TEST_CASE(
    "an output folder that cannot be created is rejected before the recordings are read; a missing "
    "one is created") {
  const CalibrationFolder folder;
  std::ofstream(folder.path / "file") << "no folder";
  std::ostringstream out, remarks;
  const auto run = [&](const fs::path& output, const std::string& recording) {
    launch::gap::CalibrateOptions options{.robot = rigs::config("hinge_rig/robot.xml")};
    options.out = output, options.recordings = {recording};
    launch::gap::calibrate(options, out, remarks);
  };
  CHECK_THROWS_WITH(run(folder.path / "file" / "built.xml", folder.path / "no_such.csv"),
                    Catch::Contains("file") && !Catch::Contains("no_such.csv"));
  run(folder.path / "new" / "built.xml", folder.recorded());
  CHECK(fs::exists(folder.path / "new" / "built.xml"));
}

TEST_CASE("a tolerance of an unknown constant is rejected before the recordings are read") {
  const CalibrationFolder folder;
  CHECK_THROWS_WITH(
      calibrated(folder.model_with(tolerance("weight", 0.1)), folder.path / "no_such.csv"),
      Catch::Contains("weight") && Catch::Contains("names no number of forearm"));
}

TEST_CASE(
    "calibrate and diagnose print the same output under mpirun with one and with two processes") {
  const CalibrationFolder folder;
  erp::Robot built = erp::read_robot(rigs::config("hinge_rig/robot.xml"));
  built.effects = {sim::effects::written({"flexor", sim::effects::GearboxViscous{0.02}})};
  std::string files;
  for (int k = 0; k < 2; ++k) {
    const fs::path file = folder.path / (std::to_string(k) + ".csv");
    std::ofstream out(file);
    recording::write_csv(
        rig_recording::table_of_run(built, {.seconds = 4, .seed = std::uint64_t(k + 1)}), out);
    files += " " + file.string();
  }
  const std::string arguments =
      " --robot " + rigs::config("hinge_rig/robot.xml") + " --real" + files;
  for (const char* verb : {"calibrate", "diagnose"}) {
    INFO(verb);
    const std::string one = printed(1, verb + arguments, folder.path);
    CHECK(one.find("flexor") != std::string::npos);
    CHECK(printed(2, verb + arguments, folder.path) == one);
  }
}
