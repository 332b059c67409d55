// Joint control in lockstep: the arm by computed force (Fig. 8 of the paper), the hinge rig by
// puller_follower (Fig. 7a), and every joint controller over the CAN gateway.
#include <fstream>

#include "interfaces/robot/robot.hpp"
#include "tests/system/joint_runs.hpp"

using namespace tests;

namespace {

using Components = std::vector<std::pair<std::string, std::string>>;  ///< name and config file

/// Writes a graph with these components and a logger.
std::string graph(const Folder& folder, const std::string& robot, const Components& components) {
  std::ofstream out(folder / "graph.xml");
  out << "<graph name=\"off\" robot=\"" << robot << "\" device=\"sim\">\n";
  for (const auto& [name, config] : components)
    out << "  <component name=\"" << name << "\" config=\"" << config << "\"/>\n";
  out << "  <component name=\"logger\"/>\n</graph>\n";
  return folder / "graph.xml";
}

/// A graph of the arm with an effect that its controllers do not model.
std::string arm_with(const Folder& folder, const std::string& type, const std::string& place,
                     const std::string& parameter, const std::string& value) {
  const std::string configs = ERP_SOURCE_DIR "/configs/arm/";
  erp::Robot robot = erp::read_robot(configs + "robot.xml");
  robot.effects = {{{}, type, place, {{{}, parameter, value}}}};
  std::ofstream(folder / "robot.xml") << erp::write_robot(robot);
  return graph(folder, "robot.xml",
               {{"joint_target", configs + "figure_8.xml"},
                {"computed_force", configs + "computed_force.xml"}});
}

/// A graph of `twin_joint` with a load that is attached to the forearm during the motion.
std::string twin_joint_with_load(const Folder& folder, double mass_kg) {
  const std::string configs = ERP_SOURCE_DIR "/configs/twin_joint/";
  std::ofstream(folder / "sim.xml")
      << "<sim><attached_load body=\"forearm\" at_m=\"0 0 -0.26\" mass_kg=\"" << mass_kg
      << "\" at_s=\"1\"/></sim>\n";
  return graph(folder, configs + "robot.xml",
               {{"sim", "sim.xml"},
                {"joint_target", configs + "reach.xml"},
                {"puller_follower", configs + "puller_follower.xml"}});
}

std::string over_can() {
  const std::string bus = "udp:239.255.42.9:" + std::to_string(23000 + own_domain);
  return " --device can --set gateway.bus=" + bus + " --set sim.bus=" + bus;
}

}  // namespace

TEST_CASE("computed force with true angles has an RMS error below 0.5° and tensions above 2 N") {
  Folder folder;
  const auto file = recorded(folder, "launch/computed_force.xml");
  for (const auto& e : errors(file, "sim", "joint_target")) {
    INFO(e.joint);
    CHECK(e.rms_rad < 0.5 * degree);
    CHECK(e.largest_rad < 2 * degree);
  }
  CHECK(smallest_tension_N(file) > 2);
}

TEST_CASE(
    "computed force with estimated angles has a joint error below 1.5° and an estimation error "
    "below 1° RMS") {
  Folder folder;
  const auto file = recorded(folder, "launch/computed_force_estimated.xml");
  for (const auto& e : errors(file, "sim", "joint_target")) CHECK(e.rms_rad < 1.5 * degree);
  for (const auto& e : errors(file, "pose_estimator", "sim")) CHECK(e.rms_rad < degree);
}

TEST_CASE("computed force with learned moment arms has an RMS error of every joint below 0.5°") {
  for (const char* source : {"network", "difference", "on_line"}) {
    Folder folder;
    CAPTURE(source);
    const auto file = recorded(folder, std::string("launch/computed_force_learnt.xml --set "
                                                   "computed_force.jacobian=") +
                                           source);
    for (const auto& e : errors(file, "sim", "joint_target")) {
      CHECK(e.rms_rad < 0.5 * degree);
      CHECK(e.largest_rad < 2 * degree);
    }
    CHECK(smallest_tension_N(file) > 2);
  }
}

TEST_CASE(
    "computed force with 0.5 kg of payload or 10 ms of command delay has a joint error below 1.5° "
    "RMS") {
  Folder loaded, delayed;
  const auto payload = arm_with(loaded, "skeleton_payload", "forearm", "mass_kg", "0.5");
  for (const auto& e : errors(recorded(loaded, payload), "sim", "joint_target"))
    CHECK(e.rms_rad < 1.5 * degree);
  const auto delay = arm_with(delayed, "bus_command_delay", "arm", "delay_s", "0.01");
  for (const auto& e : errors(recorded(delayed, delay), "sim", "joint_target"))
    CHECK(e.rms_rad < 1.5 * degree);
}

TEST_CASE(
    "puller_follower changes roles with every tension above 1 N and an RMS error below 0.5°") {
  Folder folder;
  const auto file = recorded(folder, "launch/puller_follower.xml");
  for (const auto& e : errors(file, "sim", "joint_target")) CHECK(e.rms_rad < 0.5 * degree);
  CHECK(smallest_tension_N(file) > 1);
}

TEST_CASE("two lockstep runs of the same graph give the same joint angles") {
  Folder first, second;
  const auto a = recorded(first, "launch/computed_force_estimated.xml");
  const auto b = recorded(second, "launch/computed_force_estimated.xml");
  CHECK(recording::joint_tracks(recording::McapReader(a), "sim").at("elbow").positions ==
        recording::joint_tracks(recording::McapReader(b), "sim").at("elbow").positions);
}

TEST_CASE(
    "H-infinity control of seven joints has an RMS error below 1° and every tension above 2 N") {
  Folder folder;
  const auto file = recorded(folder, "launch/puller_follower_seven.xml", 23);
  const auto joint_errors = errors(file, "sim", "joint_target");
  CHECK(joint_errors.size() == 7);
  for (const auto& e : joint_errors) {
    INFO(e.joint);
    CHECK(e.rms_rad < 1 * degree);
  }
  CHECK(smallest_tension_N(file) > 2);
}

TEST_CASE(
    "with 0.2 kg attached during motion H-infinity stays within 1.1° after 0.6 s, PD exceeds 5°") {
  const auto largest_error_rad = [](const std::string& options) {
    Folder folder;
    const auto file = recorded(folder, "launch/puller_follower_twin.xml " + options, 3);
    CHECK(smallest_tension_N(file) > 1);
    double largest = 0;
    for (const auto& e : errors(file, "sim", "joint_target", 1.6))
      largest = std::max(largest, e.largest_rad);
    return largest;
  };
  CHECK(largest_error_rad("") < 1.1 * degree);
  CHECK(largest_error_rad("--set puller_follower.law=pd --set puller_follower.smooth_s=0.005") >
        5 * degree);
}

TEST_CASE(
    "with a load that saturates the motors the limb is braked, then follows the reference again") {
  for (const double mass_kg : {0.4, 0.6, 0.8, 1.0}) {
    CAPTURE(mass_kg);
    Folder folder;
    const auto file = recorded(folder, twin_joint_with_load(folder, mass_kg), 12);
    CHECK_THAT(content(folder / "run/erp.log"), Catch::Contains("its motors saturate"));
    for (const auto& e : errors(file, "sim", "joint_target", 9)) CHECK(e.rms_rad < 0.5 * degree);
  }
}

TEST_CASE("over the CAN gateway every joint controller stays within its error limit") {
  const JointRun run = joint_run();
  CAPTURE(run.graph);
  Folder folder;
  const auto file = recorded(folder, "launch/" + run.graph + ".xml" + over_can(), run.for_s);
  CHECK(error_findings(run.graph + " over CAN", file, 0.5, run.allowed_deg) == Findings{});
  CHECK(smallest_tension_N(file) > 0.5);
}
