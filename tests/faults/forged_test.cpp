// Forged RTPS messages, which wedge the readers of a graph without DDS Security.
#include <catch2/catch.hpp>

#include "components/node/bus.hpp"
#include "components/node/clock.hpp"
#include "interfaces/topics.hpp"
#include "tests/faults/reaction_times.hpp"
#include "tests/system/background.hpp"

using namespace tests;

namespace {

/// Time from which frames arrive and an actuator has an owner; a new participant each time, because
/// forged messages disturb every reader.
std::int64_t driven_ns() {
  for (const auto end_ns = node::monotonic_ns() + 30'000'000'000; node::monotonic_ns() < end_ns;) {
    const node::Entity participant = node::join("listener");
    node::Wake wake;
    node::Reader<erp::ActuatorOwner> owners(participant, wake);
    for (int k = 0; k < 100; ++k) {
      bool is_driven = false;
      owners.take(
          [&](const erp::ActuatorOwner& m) { is_driven = m.actuators._buffer[0].owner[0]; });
      if (is_driven) return node::wall_ns();
      std::this_thread::sleep_for(10ms);
    }
  }
  return 0;
}

}  // namespace

TEST_CASE("after forged messages the graph drives the robot again") {
  const bool is_full = faults::injections() >= 20;
  const std::string attack_s = is_full ? "15" : "4";
  faults::ReactionTimes reaction("forged heartbeats, " + attack_s + " s", "driven after their end",
                                 5000);
  for (int seed = 1; seed <= (is_full ? 10 : 1); ++seed) {
    Folder folder;
    Background graph(
        {"launch", "launch/hinge_rig.xml", "--set", "target.loop=true", "--out", folder / "run"},
        folder / "out.txt");
    REQUIRE(graph.wait_for_output("all components are active"));
    REQUIRE(run(std::string(ERP_FORGER) + " " + attack_s + " " + std::to_string(seed)).exit_code ==
            0);
    const auto ended_ns = node::wall_ns();
    const auto again_ns = driven_ns();
    INFO(graph.output());
    CHECK(again_ns != 0);
    reaction.add(ended_ns, again_ns);
    CHECK(graph.output().find("no frame has reached the plant for 0.8") != std::string::npos);
    CHECK(graph.output().find("starting all processes again") != std::string::npos);
    CHECK(graph.stop() == 0);
  }
  reaction.check();
}
