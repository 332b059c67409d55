#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "interfaces/graph/graph.hpp"
#include "interfaces/recording/table.hpp"
#include "launch/erp/gap/gap.hpp"
#include "tests/sim/rigs.hpp"

namespace {

namespace fs = std::filesystem;

struct Planned {
  int code;
  std::string text;
};

/// The plan for a diagnosis with the equivalent effects `one` and `other`. `identified` is a
/// further effect of the diagnosis.
Planned plan(const fs::path& folder, const std::string& one, const std::string& other,
             const std::string& identified = "",
             const std::string& robot = rigs::config("hinge_rig/robot.xml")) {
  fs::create_directories(folder);
  std::ofstream(folder / "diagnosis.json")
      << R"({"robot": "hinge_rig", "verdict": "supported", "effects": [)" << one << ", " << other
      << (identified.empty() ? "" : ", ") << identified << R"(], "confounders": [)" << one << ", "
      << other << "]}";
  std::ostringstream out, remarks;
  const int code = launch::gap::plan({.robot = robot,
                                      .diagnosis = (folder / "diagnosis.json").string(),
                                      .out = (folder / "next").string(),
                                      .seconds = 4,
                                      .candidates = 3},
                                     out, remarks);
  return {code, out.str()};
}

std::string effect(const std::string& type, const std::string& parameter, double value) {
  return R"({"type": ")" + type + R"(", "on": "flexor", "supported": true, "parameters": {")" +
         parameter + R"(": )" + std::to_string(value) + "}}";
}

struct Folder {
  fs::path path = fs::temp_directory_path() / "erp_gap_plan_test";
  Folder() { fs::remove_all(path); }
  ~Folder() { fs::remove_all(path); }
};

}  // namespace

TEST_CASE(
    "Coulomb and viscous friction are distinguished by a motion, which is written as a graph") {
  const Folder folder;
  const Planned planned = plan(folder.path, effect("gearbox_coulomb", "extra_Nm", 0.05),
                               effect("gearbox_viscous", "extra_Nm_s_per_rad", 0.02));
  INFO(planned.text);
  REQUIRE(planned.code == 0);
  const auto graph = erp::read_graph((folder.path / "next/graph.xml").string());
  CHECK(graph.components.size() == 2);
  const auto table = recording::read_table((folder.path / "next/trajectory.csv").string());
  CHECK(table.find("time_s")->values.back() == Approx(4).margin(0.1));
  CHECK(table.find("extensor.reference") != nullptr);
  CHECK_THAT(planned.text, Catch::Contains("erp launch"));
}

TEST_CASE(
    "of two sets of equivalent effects, the first is planned for and the second is reported") {
  const Folder folder;
  const auto of_set = [](const std::string& effect, int set) {
    return effect.substr(0, effect.size() - 1) + R"(, "set": )" + std::to_string(set) + "}";
  };
  const Planned planned = plan(folder.path, of_set(effect("gearbox_coulomb", "extra_Nm", 0.05), 0),
                               of_set(effect("gearbox_viscous", "extra_Nm_s_per_rad", 0.02), 0) +
                                   ", " + of_set(effect("motor_resistance", "relative", 0.2), 1));
  INFO(planned.text);
  CHECK(planned.code == 0);
  CHECK_THAT(planned.text, Catch::Contains("1 more set of equivalent effects"));
}

TEST_CASE("identified effects are part of the robot that simulates the candidates") {
  const Folder folder;
  const auto coulomb = effect("gearbox_coulomb", "extra_Nm", 0.05),
             viscous = effect("gearbox_viscous", "extra_Nm_s_per_rad", 0.02);
  const Planned alone = plan(folder.path, coulomb, viscous);
  const Planned with_resistance =
      plan(folder.path, coulomb, viscous, effect("motor_resistance", "relative", 0.3));
  REQUIRE(with_resistance.code == 0);
  CHECK_THAT(with_resistance.text, !Catch::Contains("motor_resistance"));  // not a candidate
  CHECK(with_resistance.text != alone.text);                               // but it acts
}

TEST_CASE("a plan with the corrected robot.xml equals the plan with the diagnosed robot.xml") {
  const Folder folder;
  const auto coulomb = effect("gearbox_coulomb", "extra_Nm", 0.05),
             viscous = effect("gearbox_viscous", "extra_Nm_s_per_rad", 0.02),
             resistance = effect("motor_resistance", "relative", 0.3);
  auto corrected = erp::read_robot(rigs::config("hinge_rig/robot.xml"));
  corrected.effects = {{{}, "gearbox_coulomb", "flexor", {{{}, "extra_Nm", "0.050001"}}},
                       {{}, "motor_resistance", "flexor", {{{}, "relative", "0.3"}}}};
  fs::create_directories(folder.path);
  const auto file = (folder.path / "robot.xml").string();
  std::ofstream(file) << erp::write_robot(corrected);
  const Planned with_diagnosed = plan(folder.path, coulomb, viscous, resistance);
  const Planned with_corrected = plan(folder.path, coulomb, viscous, resistance, file);
  REQUIRE(with_diagnosed.code == 0);
  CHECK(with_corrected.text == with_diagnosed.text);
}

TEST_CASE(
    "indistinguishable effects: exit code 5, both are named, and an earlier graph is removed") {
  const Folder folder;
  fs::create_directories(folder.path / "next");
  std::ofstream(folder.path / "next/graph.xml") << "<!-- By erp gap plan. -->";
  const Planned planned = plan(folder.path, effect("tendon_length_offset", "length_m", 0.0004),
                               effect("sensor_shaft_offset", "offset_rad", -0.0889));
  INFO(planned.text);
  CHECK(planned.code == 5);
  CHECK_THAT(planned.text, Catch::Contains("distinguishes tendon_length_offset on flexor from "
                                           "sensor_shaft_offset on flexor; this needs"));
  CHECK_FALSE(fs::exists(folder.path / "next/graph.xml"));
}

TEST_CASE("a graph.xml that erp gap plan did not write is not overwritten") {
  const Folder folder;
  fs::create_directories(folder.path / "next");
  std::ofstream(folder.path / "next/graph.xml") << "<graph/>";
  CHECK_THROWS_WITH(plan(folder.path, effect("gearbox_coulomb", "extra_Nm", 0.05),
                         effect("gearbox_viscous", "extra_Nm_s_per_rad", 0.02)),
                    Catch::Contains("contains a graph.xml that erp gap plan did not write"));
  CHECK(fs::exists(folder.path / "next/graph.xml"));
}

TEST_CASE("an effect indistinguishable from the first is dropped; the others are planned for") {
  const Folder folder;
  const Planned planned = plan(folder.path, effect("tendon_length_offset", "length_m", 0.0004),
                               effect("sensor_shaft_offset", "offset_rad", -0.0889) + ", " +
                                   effect("gearbox_coulomb", "extra_Nm", 0.05));
  INFO(planned.text);
  CHECK(planned.code == 0);
  CHECK_THAT(planned.text, Catch::Contains("from sensor_shaft_offset on flexor; this needs") &&
                               Catch::Contains("suspects    tendon_length_offset on flexor, "
                                               "gearbox_coulomb on flexor"));
  CHECK(fs::exists(folder.path / "next/graph.xml"));
}

TEST_CASE("a diagnosis with a part that the robot lacks is rejected by name") {
  const Folder folder;
  auto other = effect("gearbox_coulomb", "extra_Nm", 0.05);
  other.replace(other.find("flexor"), 6, "biceps");
  CHECK_THROWS_WITH(plan(folder.path, other, other),
                    Catch::Contains("gearbox_coulomb on biceps") &&
                        Catch::Contains("pass the robot that was diagnosed"));
}

TEST_CASE("a file that is not a diagnosis.json is rejected with the missing field") {
  const Folder folder;
  CHECK_THROWS_WITH(plan(folder.path, R"({"type": "gearbox_coulomb", "on": "flexor"})", "{}"),
                    Catch::Contains("diagnosis.json: is not a diagnosis.json") &&
                        Catch::Contains("'type' not found"));
}

TEST_CASE(
    "a diagnosis of another robot is rejected, even if the robot has parts of the same names") {
  const Folder folder;
  fs::create_directories(folder.path);
  std::ofstream(folder.path / "diagnosis.json")
      << R"({"robot": "hinge_rig", "verdict": "supported", "confounders": [], "effects": [{"type":
          "sensor_joint_gain", "on": "elbow", "supported": true, "parameters": {}}]})";
  std::ostringstream out, remarks;
  CHECK_THROWS_WITH(launch::gap::plan({.robot = rigs::config("arm/robot.xml"),
                                       .diagnosis = folder.path / "diagnosis.json",
                                       .out = folder.path / "next"},
                                      out, remarks),
                    Catch::Contains("hinge_rig") && Catch::Contains("\"arm\""));
}

TEST_CASE("a missing diagnosis.json is rejected with its file name") {
  const Folder folder;
  std::ostringstream out, remarks;
  CHECK_THROWS_WITH(launch::gap::plan({.robot = rigs::config("hinge_rig/robot.xml"),
                                       .diagnosis = (folder.path / "diagnosis.json").string(),
                                       .out = folder.path.string()},
                                      out, remarks),
                    Catch::Contains("diagnosis.json"));
}

TEST_CASE("an output path that is a file is rejected, and the file is not changed") {
  const Folder folder;
  fs::create_directories(folder.path);
  std::ofstream(folder.path / "next") << "mine";
  CHECK_THROWS_WITH(plan(folder.path, effect("gearbox_coulomb", "extra_Nm", 0.05),
                         effect("gearbox_viscous", "extra_Nm_s_per_rad", 0.02)),
                    Catch::Contains("next: this folder cannot be made"));
  CHECK(fs::is_regular_file(folder.path / "next"));
}
