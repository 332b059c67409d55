// Simulated robots match robot.xml: recordings of shipped graphs show no gap with any controller.
// tests/bench/gap_graphs.sh runs the complete motions.
#include <catch2/catch.hpp>

#include "tests/system/command.hpp"

using namespace tests;
using Catch::Contains;

TEST_CASE("a recording of a shipped graph shows no gap") {
  struct Graph {
    const char *name, *robot, *length;
  };
  const Graph graph =
      GENERATE(Graph{"hinge_rig", "hinge_rig", "15s"}, Graph{"leg", "leg", "14s"},
               Graph{"seven_dof", "seven_dof", "10s"},  // joints at rest within their friction
               Graph{"pendulum", "pendulum", "20s"},    // no joint is measured
               Graph{"babble", "arm", "12s"},           // the ball joint reaches its stop
               Graph{"joint_motion", "arm", "10s"},     // tensions that change by 500 N/s
               Graph{"computed_force_estimated", "arm",
                     "8s"});  // shafts that change direction every few rows
  const Folder folder;
  const auto launched = run(std::string("erp launch launch/") + graph.name +
                            ".xml --lockstep --for " + graph.length + " --out " + folder.path());
  INFO(launched.output);
  REQUIRE(launched.exit_code == 0);
  const auto where = run(std::string("erp gap where --robot configs/") + graph.robot +
                         "/robot.xml --real " + (folder / (std::string(graph.name) + ".mcap")));
  INFO(where.output);
  CHECK(where.exit_code == 0);
  CHECK_THAT(where.output, Contains("no gap") && !Contains("the gap is in"));
}
