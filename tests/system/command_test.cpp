// erp send, set and stop command a running robot from another terminal.
#include <catch2/catch.hpp>
#include <regex>

#include "tests/system/background.hpp"

using namespace tests;

namespace {

/// A running graph of the hinge rig; `graph` names it.
struct Rig {
  Folder folder;
  Background graph;
  explicit Rig(const std::string& name)
      : graph(arguments(name, folder / "run"), folder / "out.txt") {
    REQUIRE(graph.wait_for_output("all components are active"));
  }
  static std::vector<std::string> arguments(const std::string& name, const std::string& out) {
    std::vector<std::string> arguments{"launch", "launch/" + name + ".xml", "--out", out};
    if (name == "hinge_rig") arguments.insert(arguments.end(), {"--set", "target.loop=true"});
    return arguments;
  }
};

bool contains(const Outcome& outcome, const std::string& text) {
  return outcome.output.find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("erp send drives an idle actuator, prints its tension and gives it up") {
  Rig rig("idle");
  const auto sent = run("erp send flexor extensor force 12 --for 3s");
  INFO(sent.output);
  CHECK(sent.exit_code == 0);
  CHECK(contains(sent, "flexor: force 12 N, measured 1"));
  CHECK(contains(sent, "released"));
  CHECK(rig.graph.wait_for_output("flexor: driven by erp_send_"));
  CHECK(rig.graph.wait_for_output(" released it"));
  CHECK(rig.graph.stop() == 0);
}

TEST_CASE("erp send to an actuator of a controller of higher priority names the controller") {
  Rig rig("hinge_rig");
  const auto sent = run("erp send flexor force 12 --priority -1 --for 5s");
  INFO(sent.output);
  CHECK(sent.exit_code == 1);
  CHECK(contains(sent, "flexor is driven by force_control with priority 0; raise --priority"));
  CHECK(rig.graph.stop() == 0);
  const std::regex refusals(
      "flexor: [0-9]+ references limited, [1-9][0-9]* refused: another controller");
  CHECK(std::regex_search(rig.graph.output(), refusals));  // in the summary of the run
}

TEST_CASE("the verbs also work in a lockstep graph") {
  const Folder folder;
  Background graph(
      {"launch", "launch/idle.xml", "--lockstep", "--for", "60min", "--out", folder / "run"},
      folder / "out.txt");
  REQUIRE(graph.wait_for_output("all components are active"));
  const auto sent = run("erp send flexor force 12 --for 1s");
  INFO(sent.output);
  CHECK(sent.exit_code == 0);
  CHECK(run("erp set flexor length_gain_V_per_rad=3").exit_code == 0);
  CHECK(run("erp stop").exit_code == 0);
  graph.stop();
}

TEST_CASE("erp send ends with the fault of an ECU") {
  Rig rig("idle");
  REQUIRE(run("erp set flexor tension_limit_N=20 tension_trip_N=21").exit_code == 0);
  const auto sent = run("erp send flexor force 60 --for 5s");
  INFO(sent.output);
  CHECK(sent.exit_code == 1);
  CHECK(contains(sent, "flexor: its ECU has switched off with fault"));
  rig.graph.stop();
}

TEST_CASE("wrong words of erp send and set are refused with the known names") {
  Rig rig("idle");
  const auto check = [](const std::string& arguments, const std::string& message) {
    const auto outcome = run("erp " + arguments);
    INFO(outcome.output);
    CHECK(outcome.exit_code == 2);
    CHECK(contains(outcome, message));
  };
  check("send flexer force 1", "did you mean \"flexor\"");
  check("send flexor farce 1", "did you mean \"force\"");
  check("send flexor force much", "must be a number");
  check("send flexor force 1 --robot arm", "no robot \"arm\"");
  check("send flexor off 5", "off has no value");
  check("send flexor force 5 --priority 2147483647", "not in range");
  check("set flexor length_gain_V_per_rad", "is not NAME=VALUE");
  rig.graph.stop();
}

TEST_CASE("erp set succeeds when the ECU has accepted the gain, and prints why it is refused") {
  Rig rig("idle");
  const auto accepted = run("erp set flexor length_gain_V_per_rad=3");
  INFO(accepted.output);
  CHECK(accepted.exit_code == 0);
  for (int k = 0; k < 2; ++k) {  // a repeated refusal also has an answer
    const auto by_ecu = run("erp set flexor length_gain_V_per_rad=-1");
    CHECK(by_ecu.exit_code == 1);
    CHECK(contains(by_ecu, "its ECU refuses"));
    const auto by_plant = run("erp set flexor tension_trip_N=500");
    CHECK(by_plant.exit_code == 1);
    CHECK(contains(by_plant, "at most robot.xml's 180, got 500"));
  }
  CHECK(rig.graph.stop() == 0);
}

TEST_CASE("erp stop keeps every actuator off, against its controller, until erp stop --release") {
  Rig rig("hinge_rig");
  const auto stopped = run("erp stop");
  INFO(stopped.output);
  CHECK(stopped.exit_code == 0);
  CHECK(contains(stopped, "hinge_rig: the plant keeps 2 actuators off"));
  CHECK(rig.graph.wait_for_output("emergency off by erp_stop"));
  const auto sent = run("erp send flexor force 12 --for 2s");
  CHECK(sent.exit_code == 1);
  const auto frames = run("erp echo ecu_frame -n 20 | grep -c 'duty_counts: 0$'");
  CHECK(frames.output == "40\n");
  const auto released = run("erp stop --release");
  CHECK(released.exit_code == 0);
  CHECK(contains(released, "2 actuators released"));
  CHECK(run("erp send flexor force 12 --for 2s").exit_code == 0);
  rig.graph.stop();
}

TEST_CASE("erp doctor examines this computer, and a wrong domain is a problem with a remedy") {
  const auto examined = run("erp doctor configs/hinge_rig/robot.xml");
  INFO(examined.output);
  for (const auto& what : {"programs", "real-time priority", "loopback", "DDS domain", "wall clock",
                           "CAN", "bus rig on can0", "disk", " problems, "})
    CHECK(contains(examined, what));
  const auto wrong = run("ERP_DOMAIN=300 erp doctor");
  CHECK(wrong.exit_code == 1);
  CHECK(contains(wrong, "PROBLEM  DDS domain 300"));
  CHECK(contains(wrong, "→ end other programs of this domain"));
  CHECK(run("erp doctor no_such_file.xml").exit_code == 2);
}

TEST_CASE("a device that stops while its process lives is reported within 1 s, and its return") {
  Rig rig("idle");
  std::this_thread::sleep_for(1s);
  const pid_t sim = rig.graph.child("sim");
  REQUIRE(sim > 0);
  kill(sim, SIGSTOP);
  CHECK(rig.graph.wait_for_output("no frame has reached the plant for "));
  CHECK(rig.graph.wait_for_output("no heartbeat from sim"));
  kill(sim, SIGCONT);
  CHECK(rig.graph.wait_for_output("frames reach the plant again after"));
  rig.graph.stop();
}

TEST_CASE("without a robot, erp stop fails and names the remedy") {
  const auto stopped = run("erp stop");
  CHECK(stopped.exit_code == 1);
  CHECK(contains(stopped, "ERP_DOMAIN"));
}
