// Two processes that claim to be the same part of one robot: the later one leaves.
#include <catch2/catch.hpp>

#include "tests/system/background.hpp"

using namespace tests;

TEST_CASE("a second plant of the same robot leaves, naming the first, which goes on") {
  const Folder folder;
  Background graph({"launch", "launch/hinge_rig.xml", "--out", folder / "run"}, folder / "out.txt");
  REQUIRE(graph.says("all components are active"));
  const pid_t first = graph.child("plant");
  const auto second = run("plant --robot configs/hinge_rig/robot.xml");
  INFO(second.output);
  CHECK(second.exit_code == 2);
  CHECK(second.output.find("pid " + std::to_string(first)) != std::string::npos);
  CHECK(second.output.find("ERP_DOMAIN") != std::string::npos);
  CHECK(kill(first, 0) == 0);
  CHECK(graph.stop() == 0);
}

TEST_CASE("the same part of another robot is no namesake") {
  const Folder folder;
  Background graph({"launch", "launch/hinge_rig.xml", "--out", folder / "run"}, folder / "out.txt");
  REQUIRE(graph.says("all components are active"));
  const auto other = run("timeout --preserve-status -s INT 2 plant --robot configs/arm/robot.xml");
  INFO(other.output);
  CHECK(other.exit_code == 0);
  CHECK(graph.stop() == 0);
}
