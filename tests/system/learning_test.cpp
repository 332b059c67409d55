// Learning controllers on running graphs, with the simulator and over the CAN gateway.
#include <catch2/catch.hpp>
#include <iostream>
#include <numeric>
#include <regex>

#include "interfaces/xml/xml.hpp"
#include "sim/learning/experience/base_file.hpp"
#include "sim/learning/sensorimotor/learned_map_file.hpp"
#include "sim/learning/synergy/bank_file.hpp"
#include "tests/system/command.hpp"

using namespace tests;
namespace sensorimotor = sim::sensorimotor;

namespace {

constexpr int trials = 8;

/// The pendulum with two goals in its camera's image; 76 s in all.
void write_graph(const Folder& folder, const std::string& learned = "") {
  const std::string configs = ERP_SOURCE_DIR "/configs/pendulum/";
  std::ofstream(folder / "sensorimotor.xml")
      << "<sensorimotor view=\"" << configs << "view.xml\" twitches=\"16\" trials=\"" << trials
      << "\" save=\"saved.xml\"" << learned
      << "><goal at=\"0.12 -0.05\"/><goal at=\"-0.1 -0.12\"/></sensorimotor>";
  std::ofstream(folder / "graph.xml")
      << "<graph name=\"learning\" robot=\"" << configs << "robot.xml\" device=\"sim\">"
      << "<component name=\"eye\" config=\"" << configs << "eye.xml\"/>"
      << "<component name=\"sensorimotor\" config=\"sensorimotor.xml\"/></graph>";
}

std::string device_options(const std::string& device) {
  const std::string bus = "udp:239.255.42.9:" + std::to_string(23100 + own_domain);
  return device == "sim" ? "" : " --device can --set gateway.bus=" + bus + " --set sim.bus=" + bus;
}

sensorimotor::LearnedMapFile learned_map_in(const Folder& folder) {
  return xml::read<sensorimotor::LearnedMapFile>(folder / "saved.xml");
}

}  // namespace

TEST_CASE(
    "a pendulum learns to reach two goals, reduces the error by 80 %, and reuses the saved model") {
  const std::string device = GENERATE("sim", "can");
  CAPTURE(device);
  Folder folder;
  write_graph(folder);
  const auto outcome = run("erp launch " + (folder / "graph.xml") + device_options(device) +
                           " --lockstep --for 76s --out " + (folder / "run"));
  INFO(outcome.output);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.output, Catch::Contains("2 of 2: error"));
  const auto file = learned_map_in(folder);
  const Eigen::MatrixXd signs = (Eigen::MatrixXd(2, 4) << 1, 1, -1, -1, -1, 1, 1, -1).finished();
  CHECK(learned_map_of(file, 2, 4).q().cwiseProduct(signs).minCoeff() > 0.1);
  for (const auto& goal : file.goals) {
    REQUIRE(goal.errors.size() == trials);
    std::cout << "over " << device << ": error " << goal.errors.front() << " at the first attempt, "
              << goal.errors.back() << " at the last\n";
    CHECK(goal.errors.back() < 0.2 * goal.errors.front());
  }

  std::filesystem::rename(folder / "saved.xml", folder / "before.xml");
  write_graph(folder, " learned=\"before.xml\"");
  REQUIRE(run("erp launch " + (folder / "graph.xml") + device_options(device) +
              " --lockstep --for 60s --out " + (folder / "again"))
              .exit_code == 0);
  const auto second_run = learned_map_in(folder);
  for (std::size_t g = 0; g < second_run.goals.size(); ++g) {
    REQUIRE(!second_run.goals[g].errors.empty());
    CHECK(second_run.goals[g].errors.front() < 0.5 * file.goals[g].errors.front());
  }
}

TEST_CASE("an arm reaches two goals by stored experience and feedback, and stores both") {
  const std::string device = GENERATE("sim", "can");
  const std::string feedback = GENERATE("linear", "fuzzy");
  CAPTURE(device, feedback);
  Folder folder;
  const std::string configs = ERP_SOURCE_DIR "/configs/seven_dof/";
  std::filesystem::copy_file(configs + "experience_base.xml", folder / "base.xml");
  std::filesystem::copy_file(configs + "feedback.fll", folder / "feedback.fll");
  std::ofstream(folder / "experience.xml")
      << "<experience base=\"base.xml\" save=\"saved.xml\" rules=\"feedback.fll\" feedback=\""
      << feedback
      << "\"><goal at_m=\"0.3 -0.3 -0.5\"/><goal at_m=\"0.4 -0.25 -0.45\"/></experience>";
  std::ofstream(folder / "graph.xml")
      << "<graph name=\"learning\" robot=\"" << configs << "robot.xml\" device=\"sim\">"
      << "<component name=\"experience\" config=\"experience.xml\"/></graph>";
  const auto outcome = run("erp launch " + (folder / "graph.xml") + device_options(device) +
                           " --lockstep --for 21s --out " + (folder / "run"));
  INFO(outcome.output);
  REQUIRE(outcome.exit_code == 0);
  const std::regex line(
      "offset (\\S+) (\\S+) (\\S+) mm before feedback, (\\S+) (\\S+) (\\S+) mm after it");
  int reached = 0;
  for (std::sregex_iterator it(outcome.output.begin(), outcome.output.end(), line), end; it != end;
       ++it, ++reached)
    for (int axis = 1; axis <= 3; ++axis) {
      CHECK(std::abs(std::stod((*it)[axis])) < 6);
      CHECK(std::abs(std::stod((*it)[axis + 3])) < 1);
    }
  CHECK(reached == 2);
  const auto before = xml::read<sim::experience::BaseFile>(folder / "base.xml");
  const auto after = xml::read<sim::experience::BaseFile>(folder / "saved.xml");
  CHECK(after.experiences.all.size() == before.experiences.all.size() + 2);
}

TEST_CASE("the torso strikes two targets by motor synergies and updates its synergy bank") {
  const std::string device = GENERATE("sim", "can");
  CAPTURE(device);
  Folder folder;
  const std::string configs = ERP_SOURCE_DIR "/configs/ecce2/";
  std::filesystem::copy_file(configs + "synergy_bank.xml", folder / "bank.xml");
  std::ofstream(folder / "synergy.xml")
      << "<synergy bank=\"bank.xml\" save=\"saved.xml\"><target at_m=\"0.34 -0.2 0.1\"/>"
      << "<target at_m=\"0.36 -0.12 0.2\"/></synergy>";
  std::ofstream(folder / "graph.xml")
      << "<graph name=\"learning\" robot=\"" << configs << "robot.xml\" device=\"sim\">"
      << "<component name=\"synergy\" config=\"synergy.xml\"/></graph>";
  const auto outcome = run("erp launch " + (folder / "graph.xml") + device_options(device) +
                           " --lockstep --for 17.5s --out " + (folder / "run"));
  INFO(outcome.output);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.output, Catch::Contains("2 of 2 struck"));
  const auto before = xml::read<sim::synergy::BankFile>(folder / "bank.xml");
  const auto after = xml::read<sim::synergy::BankFile>(folder / "saved.xml");
  CHECK(xml::write(after) != xml::write(before));
}
