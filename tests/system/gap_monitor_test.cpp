// gap_monitor compares a robot with additional friction with the nominal model: live residuals and one event.
#include <catch2/catch.hpp>
#include <fstream>

#include "interfaces/robot/robot.hpp"
#include "tests/system/background.hpp"
#include "tests/system/recorded.hpp"

using namespace tests;

namespace {

const std::string configs = ERP_SOURCE_DIR "/configs/hinge_rig/";

void write(const std::string& file, const std::string& text) { std::ofstream(file) << text; }

/// A graph of the rig with Coulomb friction in the gearbox of the extensor; gap_monitor uses the model without it.
std::string monitored_graph(const Folder& folder) {
  erp::Robot robot = erp::read_robot(configs + "robot.xml");
  robot.effects = {{{}, "gearbox_coulomb", "extensor", {{{}, "extra_Nm", "0.05"}}}};
  write(folder / "robot.xml", erp::write_robot(robot));
  write(folder / "monitor.xml",
        "<gap_monitor model=\"" + configs + "robot.xml\" window_s=\"3\"/>\n");
  const auto component = [](const std::string& name, const std::string& config) {
    return "  <component name=\"" + name + "\" config=\"" + config + "\"/>\n";
  };
  write(folder / "graph.xml", "<graph name=\"watched\" robot=\"robot.xml\" device=\"sim\">\n" +
                                  component("target", configs + "target.xml") +
                                  component("force_control", configs + "force_control.xml") +
                                  component("gap_monitor", "monitor.xml") +
                                  "  <component name=\"logger\"/>\n</graph>\n");
  return folder / "graph.xml";
}

}  // namespace

TEST_CASE("gap_monitor reports one event, for the stage whose residual exceeds the noise") {
  Folder folder;
  const auto outcome =
      run("erp launch " + monitored_graph(folder) + " --for 12s --out " + (folder / "run"));
  INFO(outcome.output);
  REQUIRE(outcome.exit_code == 0);
  const std::string file = folder / "run/watched.mcap";
  std::size_t count = 0;
  const Recorded events(file, "event");
  for (const auto& event : events.messages())
    if (text(event, "code") == "gap_open") {
      CHECK(text(event, "subject") == "extensor");
      CHECK_THAT(text(event, "text"), Catch::Contains("gearbox of extensor"));
      ++count;
    }
  CHECK(count == 1);
  const Recorded residuals(file, "stage_residual");
  REQUIRE(residuals.messages().size() >= 3);
  for (const auto& stage : elements(residuals.messages().back(), "stages")) {
    const auto& s = *stage.members();
    if (text(s, "stage") == "motor") CHECK(number(s, "residual") < 2 * number(s, "floor"));
  }
}
