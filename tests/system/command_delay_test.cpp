// A delay of the bus is detected in recordings of a running graph, from the sent and the executed
// commands.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "interfaces/robot/robot.hpp"
#include "tests/system/command.hpp"

using namespace tests;
using Catch::Contains;

namespace {

const std::string configs = ERP_SOURCE_DIR "/configs/hinge_rig/";

/// The rig with force control on the host. Its commands are voltages, so the control law of the ECU
/// cannot be used to infer them.
struct Rig {
  Folder folder;

  explicit Rig(double delay_s) {
    erp::Robot robot = erp::read_robot(configs + "robot.xml");
    if (delay_s > 0)
      robot.effects = {
          {{}, "bus_command_delay", "hinge_rig", {{{}, "delay_s", std::to_string(delay_s)}}}};
    std::ofstream(folder / "robot.xml") << erp::write_robot(robot);
    std::ofstream(folder / "graph.xml")
        << "<graph name=\"rig\" robot=\"robot.xml\" device=\"sim\">\n"
        << "<component name=\"target\" config=\"" << configs << "target.xml\"/>\n"
        << "<component name=\"force_control\" config=\"" << configs << "force_control.xml\"/>\n"
        << "<component name=\"logger\"/>\n</graph>\n";
  }

  std::string recorded(const std::string& name, const std::string& seconds) const {
    const auto outcome = run("erp launch " + (folder / "graph.xml") + " --lockstep --for " +
                             seconds + " --out " + (folder / name));
    INFO(outcome.output);
    REQUIRE(outcome.exit_code == 0);
    return folder / (name + "/rig.mcap");
  }
  Outcome gap(const std::string& arguments) const {
    return run("erp gap " + arguments + " --robot " + configs + "robot.xml");
  }
};

}  // namespace

TEST_CASE("a command delay of 20 ms is identified within 2 ms and closes the free-run gap") {
  const Rig rig(0.02);
  const std::string real = " --real " + rig.recorded("a", "8s") + " " + rig.recorded("b", "6s");
  CHECK_THAT(rig.gap("where" + real).output,
             Contains("the bus is late: in ") && Contains("no gap elsewhere"));
  const auto outcome = rig.gap("diagnose" + real + " --out " + (rig.folder / "found"));
  INFO(outcome.output);
  REQUIRE(outcome.exit_code == 0);
  std::ifstream file(rig.folder / "found/diagnosis.json");
  const auto diagnosis = nlohmann::json::parse(file);
  CHECK(diagnosis["where"][0]["stage"] == "bus");
  const auto& delay =
      diagnosis["effects"][0];  // delayed commands and delayed frames are indistinguishable
  CHECK_THAT(delay["type"].get<std::string>(), Contains("bus_") && Contains("_delay"));
  CHECK(delay["parameters"]["delay_s"].get<double>() == Approx(0.02).margin(0.002));
  CHECK(diagnosis["gap"]["free_running"]["closed"].get<double>() > 0.95);
}

TEST_CASE("without a delay the bus is evaluated and the verdict is no_gap") {
  const Rig rig(0);
  const std::string real = " --real " + rig.recorded("a", "8s") + " " + rig.recorded("b", "6s");
  const auto outcome = rig.gap("diagnose" + real);
  INFO(outcome.output);
  CHECK(outcome.exit_code == 3);
  CHECK_THAT(outcome.output, Contains("no_gap") && !Contains("in the evaluated stages"));
}
