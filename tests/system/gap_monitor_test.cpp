// The nominal model beside a robot that has more friction than it: residuals live, an event.
#include <catch2/catch.hpp>
#include <fstream>

#include "interfaces/robot/robot.hpp"
#include "tests/system/background.hpp"
#include "tests/system/recorded.hpp"

using namespace tests;

namespace {

const std::string configs = ERP_SOURCE_DIR "/configs/hinge_rig/";

void write(const std::string& file, const std::string& text) { std::ofstream(file) << text; }

/// A graph of the rig whose extensor's gearbox drags, watched by the model that does not know.
std::string watched_graph(const Folder& folder) {
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

TEST_CASE("the monitor says live which stage leaves its floor, and only that one") {
  Folder folder;
  const auto outcome =
      run("erp launch " + watched_graph(folder) + " --for 12s --out " + (folder / "run"));
  INFO(outcome.output);
  REQUIRE(outcome.exit_code == 0);
  const std::string file = folder / "run/watched.mcap";
  std::size_t told = 0;
  const Recorded events(file, "event");
  for (const auto& event : events.messages())
    if (text(event, "code") == "gap_open") {
      CHECK(text(event, "subject") == "extensor");
      CHECK_THAT(text(event, "text"), Catch::Contains("gearbox of extensor"));
      ++told;
    }
  CHECK(told == 1);
  const Recorded residuals(file, "stage_residual");
  REQUIRE(residuals.messages().size() >= 3);
  for (const auto& stage : elements(residuals.messages().back(), "stages")) {
    const auto& s = *stage.members();
    if (text(s, "stage") == "motor") CHECK(number(s, "residual") < 2 * number(s, "floor"));
  }
}
