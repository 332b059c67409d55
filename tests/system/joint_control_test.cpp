// Joints under control, in lockstep: the arm by computed force (the paper's Fig. 8), the hinge rig by
// puller and follower (Fig. 7a).
#include <fstream>

#include "interfaces/robot/robot.hpp"
#include "tests/system/joint_runs.hpp"

using namespace tests;

namespace {

using Components = std::vector<std::pair<std::string, std::string>>;  ///< each, and its config

/// A graph in the folder, of these and a logger.
std::string graph(const Folder& folder, const std::string& robot, const Components& components) {
  std::ofstream out(folder / "graph.xml");
  out << "<graph name=\"off\" robot=\"" << robot << "\" device=\"sim\">\n";
  for (const auto& [name, config] : components)
    out << "  <component name=\"" << name << "\" config=\"" << config << "\"/>\n";
  out << "  <component name=\"logger\"/>\n</graph>\n";
  return folder / "graph.xml";
}

/// The arm with something that its controllers do not know.
std::string arm_with(const Folder& folder, const std::string& type, const std::string& on,
                     const std::string& parameter, const std::string& value) {
  const std::string configs = ERP_SOURCE_DIR "/configs/arm/";
  erp::Robot robot = erp::read_robot(configs + "robot.xml");
  robot.effects = {{{}, type, on, {{{}, parameter, value}}}};
  std::ofstream(folder / "robot.xml") << erp::write_robot(robot);
  return graph(folder, "robot.xml",
               {{"joint_target", configs + "figure_8.xml"},
                {"computed_force", configs + "computed_force.xml"}});
}

/// `twin_joint`, which on its way grasps as much.
std::string twin_grasps(const Folder& folder, double mass_kg) {
  const std::string configs = ERP_SOURCE_DIR "/configs/twin_joint/";
  std::ofstream(folder / "sim.xml") << "<sim><grasp body=\"forearm\" at_m=\"0 0 -0.26\" mass_kg=\""
                                    << mass_kg << "\" at_s=\"1\"/></sim>\n";
  return graph(folder, configs + "robot.xml",
               {{"sim", "sim.xml"},
                {"joint_target", configs + "reach.xml"},
                {"puller_follower", configs + "puller_follower.xml"}});
}

}  // namespace

TEST_CASE("with true angles all joints follow to half a degree, and every tendon stays taut") {
  Folder folder;
  const auto file = recorded(folder, "launch/computed_force.xml");
  for (const auto& e : errors(file, "sim", "joint_target")) {
    INFO(e.joint);
    CHECK(e.rms_rad < 0.5 * degree);
    CHECK(e.largest_rad < 2 * degree);
  }
  CHECK(least_tension_N(file) > 2);
}

TEST_CASE("with the estimator alone they follow to a degree and a half, and it is true to one") {
  Folder folder;
  const auto file = recorded(folder, "launch/computed_force_estimated.xml");
  for (const auto& e : errors(file, "sim", "joint_target")) CHECK(e.rms_rad < 1.5 * degree);
  for (const auto& e : errors(file, "pose_estimator", "sim")) CHECK(e.rms_rad < degree);
}

TEST_CASE("by what was learnt of its muscles the arm follows as well: beforehand, or on the way") {
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
    CHECK(least_tension_N(file) > 2);
  }
}

TEST_CASE("half a kilogram in the hand, or 10 ms of delay, are borne") {
  Folder loaded, late;
  const auto payload = arm_with(loaded, "skeleton_payload", "forearm", "mass_kg", "0.5");
  for (const auto& e : errors(recorded(loaded, payload), "sim", "joint_target"))
    CHECK(e.rms_rad < 1.5 * degree);
  const auto delay = arm_with(late, "bus_command_delay", "arm", "delay_s", "0.01");
  for (const auto& e : errors(recorded(late, delay), "sim", "joint_target"))
    CHECK(e.rms_rad < 1.5 * degree);
}

TEST_CASE("puller and follower change roles without slack, to half a degree") {
  Folder folder;
  const auto file = recorded(folder, "launch/puller_follower.xml");
  for (const auto& e : errors(file, "sim", "joint_target")) CHECK(e.rms_rad < 0.5 * degree);
  CHECK(least_tension_N(file) > 1);
}

TEST_CASE("the same run twice is the same") {
  Folder first, second;
  const auto a = recorded(first, "launch/computed_force_estimated.xml");
  const auto b = recorded(second, "launch/computed_force_estimated.xml");
  CHECK(recording::joint_tracks(recording::McapReader(a), "sim").at("elbow").at ==
        recording::joint_tracks(recording::McapReader(b), "sim").at("elbow").at);
}

TEST_CASE("seven joints follow to a degree by H-infinity loops, and every tendon stays taut") {
  Folder folder;
  const auto file = recorded(folder, "launch/puller_follower_seven.xml", 23);
  const auto found = errors(file, "sim", "joint_target");
  CHECK(found.size() == 7);
  for (const auto& e : found) {
    INFO(e.joint);
    CHECK(e.rms_rad < 1 * degree);
  }
  CHECK(least_tension_N(file) > 2);
}

TEST_CASE("a limb that grasps 0.2 kg on its way is soon back where it should be; by PD it is not") {
  const auto off = [](const std::string& more) {
    Folder folder;
    const auto file = recorded(folder, "launch/puller_follower_twin.xml " + more, 3);
    CHECK(least_tension_N(file) > 1);
    double largest = 0;
    for (const auto& e : errors(file, "sim", "joint_target", 1.5))
      largest = std::max(largest, e.largest_rad);
    return largest;
  };
  CHECK(off("") < 1.1 * degree);  // the shoulder at 1.5 s; from 1.6 s on 0.2
  CHECK(off("--set puller_follower.law=pd --set puller_follower.smooth_s=0.005") > 5 * degree);
}

TEST_CASE("a limb that catches more than its motors can follow is braked, then led on") {
  for (const double mass_kg : {0.3, 0.4, 0.6, 0.8}) {
    CAPTURE(mass_kg);
    Folder folder;
    const auto file = recorded(folder, twin_grasps(folder, mass_kg), 12);
    CHECK_THAT(content(folder / "run/erp.log"), Catch::Contains("asks more of its motors"));
    for (const auto& e : errors(file, "sim", "joint_target", 9)) CHECK(e.rms_rad < 0.5 * degree);
  }
}
