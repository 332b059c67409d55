// Controllers that learn, on live graphs: beside the simulator, and over the CAN gateway.
#include <catch2/catch.hpp>
#include <iostream>
#include <numeric>

#include "interfaces/xml/xml.hpp"
#include "sim/sensorimotor/learnt_file.hpp"
#include "tests/system/command.hpp"

using namespace tests;
namespace sensorimotor = sim::sensorimotor;

namespace {

constexpr int tries = 8;

/// The pendulum with two goals in its camera's image; 76 s in all.
void write_graph(const Folder& folder, const std::string& learnt = "") {
  const std::string configs = ERP_SOURCE_DIR "/configs/pendulum/";
  std::ofstream(folder / "sensorimotor.xml")
      << "<sensorimotor view=\"" << configs << "view.xml\" twitches=\"16\" tries=\"" << tries
      << "\" save=\"saved.xml\"" << learnt
      << "><goal at=\"0.12 -0.05\"/><goal at=\"-0.1 -0.12\"/></sensorimotor>";
  std::ofstream(folder / "graph.xml")
      << "<graph name=\"learning\" robot=\"" << configs << "robot.xml\" device=\"sim\">"
      << "<component name=\"eye\" config=\"" << configs << "eye.xml\"/>"
      << "<component name=\"sensorimotor\" config=\"sensorimotor.xml\"/></graph>";
}

std::string over(const std::string& device) {
  const std::string bus = "udp:239.255.42.9:" + std::to_string(23100 + own_domain);
  return device == "sim" ? "" : " --device can --set gateway.bus=" + bus + " --set sim.bus=" + bus;
}

sensorimotor::LearntFile learnt_in(const Folder& folder) {
  return xml::read<sensorimotor::LearntFile>(folder / "saved.xml");
}

}  // namespace

TEST_CASE(
    "on a live graph a pendulum twitches and learns to reach, and goes on with what it knows") {
  const std::string device = GENERATE("sim", "can");
  CAPTURE(device);
  Folder folder;
  write_graph(folder);
  const auto outcome = run("erp launch " + (folder / "graph.xml") + over(device) +
                           " --lockstep --for 76s --out " + (folder / "run"));
  INFO(outcome.output);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.output, Catch::Contains("2 of 2: error"));
  const auto file = learnt_in(folder);
  const Eigen::MatrixXd signs = (Eigen::MatrixXd(2, 4) << 1, 1, -1, -1, -1, 1, 1, -1).finished();
  CHECK(learnt_of(file, 2, 4).q().cwiseProduct(signs).minCoeff() > 0.1);
  for (const auto& goal : file.goals) {
    REQUIRE(goal.errors.size() == tries);
    std::cout << "over " << device << ": error " << goal.errors.front() << " at first, "
              << goal.errors.back() << " at last\n";
    CHECK(goal.errors.back() < 0.35 * goal.errors.front());
  }

  std::filesystem::rename(folder / "saved.xml", folder / "before.xml");
  write_graph(folder, " learnt=\"before.xml\"");
  REQUIRE(run("erp launch " + (folder / "graph.xml") + over(device) +
              " --lockstep --for 50s --out " + (folder / "again"))
              .exit_code == 0);
  const auto again = learnt_in(folder);
  for (std::size_t g = 0; g < again.goals.size(); ++g)
    CHECK(again.goals[g].errors.front() < 0.5 * file.goals[g].errors.front());
}
