// Two processes of the same component of one robot: the process that joined later exits.
#include <catch2/catch.hpp>

#include "tests/system/background.hpp"

using namespace tests;

TEST_CASE("a second plant of the same robot exits with the pid of the first, which continues") {
  const Folder folder;
  Background graph({"launch", "launch/hinge_rig.xml", "--out", folder / "run"}, folder / "out.txt");
  REQUIRE(graph.wait_for_output("all components are active"));
  const pid_t first = graph.child("plant");
  const auto second = run("plant --robot configs/hinge_rig/robot.xml");
  INFO(second.output);
  CHECK(second.exit_code == 2);
  CHECK(second.output.find("pid " + std::to_string(first)) != std::string::npos);
  CHECK(second.output.find("ERP_DOMAIN") != std::string::npos);
  CHECK(kill(first, 0) == 0);
  CHECK(graph.stop() == 0);
}

TEST_CASE("a second plant and a second device under other names exit, and the graph continues") {
  const Folder folder;
  Background graph({"launch", "launch/hinge_rig.xml", "--out", folder / "run"}, folder / "out.txt");
  REQUIRE(graph.wait_for_output("all components are active"));
  for (const std::string program : {"plant", "sim"}) {
    const auto second = run(program + " --name other --robot configs/hinge_rig/robot.xml");
    INFO(second.output);
    CHECK(second.exit_code == 2);
    CHECK(second.output.find("pid " + std::to_string(graph.child(program))) != std::string::npos);
  }
  CHECK(graph.children().size() == 5);
  CHECK(graph.stop() == 0);
}

TEST_CASE("a participant that claims to be an older plant does not displace the running one") {
  const Folder folder;
  Background graph({"launch", "launch/hinge_rig.xml", "--out", folder / "run"}, folder / "out.txt");
  REQUIRE(graph.wait_for_output("all components are active"));
  const pid_t first = graph.child("plant");
  const auto claim = run(ERP_INTRUDER " configs/hinge_rig/robot.xml 2 plant");
  INFO(claim.output);
  REQUIRE(claim.exit_code == 0);
  CHECK(graph.child("plant") == first);
  CHECK(graph.wait_for_output("this process continues"));
  CHECK(graph.stop() == 0);
  CHECK(graph.output().find("restarted") == std::string::npos);
}

TEST_CASE("a plant of another robot starts beside the first") {
  const Folder folder;
  Background graph({"launch", "launch/hinge_rig.xml", "--out", folder / "run"}, folder / "out.txt");
  REQUIRE(graph.wait_for_output("all components are active"));
  const auto other = run("timeout --preserve-status -s INT 2 plant --robot configs/arm/robot.xml");
  INFO(other.output);
  CHECK(other.exit_code == 0);
  CHECK(graph.stop() == 0);
}
