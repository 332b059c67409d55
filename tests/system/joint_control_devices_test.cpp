// Controllers of joints as on a robot: over the CAN gateway, with a plant that is killed while the
// limbs move, and on a machine that has more to do than it can.
#include <atomic>
#include <iostream>

#include "components/node/real_time.hpp"

#include "tests/system/background.hpp"
#include "tests/system/joint_runs.hpp"

using namespace tests;

namespace {

struct Led {
  std::string graph;
  int for_s;
  double allowed_deg;  ///< RMS error of each joint
};

Led led() {
  return GENERATE(Led{"puller_follower", 12, 0.5}, Led{"puller_follower_twin", 5, 1.5},
                  Led{"puller_follower_seven", 12, 1}, Led{"computed_force", 29, 0.5},
                  Led{"computed_force_estimated", 29, 1.5});
}

std::string over_can() {
  const std::string bus = "udp:239.255.42.9:" + std::to_string(23000 + own_domain);
  return " --device can --set gateway.bus=" + bus + " --set sim.bus=" + bus;
}

/// More threads than the machine has cores, that never rest.
class Hogs {
 public:
  Hogs() {
    for (unsigned k = 0; k < std::thread::hardware_concurrency() + 1; ++k)
      threads_.emplace_back([this] {
        while (!end_) {
        }
      });
  }
  ~Hogs() {
    end_ = true;
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  std::atomic<bool> end_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace

TEST_CASE("over the gateway every controller of joints follows as it does beside the simulator") {
  const Led run = led();
  CAPTURE(run.graph);
  Folder folder;
  const auto file = recorded(folder, "launch/" + run.graph + ".xml" + over_can(), run.for_s);
  for (const auto& e : errors(file, "sim", "joint_target")) {
    std::cout << run.graph << " over CAN: " << e.joint << " " << e.rms_rad / degree << "° RMS, "
              << e.largest_rad / degree << "° at most\n";
    CHECK(e.rms_rad < run.allowed_deg * degree);
  }
  CHECK(least_tension_N(file) > 0.5);
}

TEST_CASE("a plant that is killed and comes back: the joints are soon where they should be") {
  const Led run = led();
  CAPTURE(run.graph);
  Folder folder;
  Background graph({"launch", "launch/" + run.graph + ".xml", "--out", folder / "run"},
                   folder / "run.txt");
  REQUIRE(graph.says("all components are active"));
  std::this_thread::sleep_for(3s);
  const pid_t plant = graph.child("plant");
  REQUIRE(plant > 0);
  kill(plant, SIGKILL);
  std::this_thread::sleep_for(9s);
  INFO(graph.output());
  CHECK(graph.stop() == 0);
  const auto file = recording_in(folder / "run");
  for (const auto& e : errors(file, "sim", "joint_target", 9)) {
    std::cout << run.graph << ", plant killed: " << e.joint << " " << e.rms_rad / degree
              << "° RMS, " << e.largest_rad / degree << "° at most from 9 s on\n";
    CHECK(e.rms_rad < (run.allowed_deg + 0.5) * degree);
  }
}

TEST_CASE("on a machine that is busy the joints are led as on an idle one") {
  REQUIRE(node::may_run_in_real_time());  // as root, or with ulimit -r 60
  const Led run{"puller_follower_twin", 12, 1.5};
  Folder folder;
  const Hogs hogs;
  const auto outcome =
      tests::run("erp launch launch/" + run.graph + ".xml --for 12s --out " + (folder / "run"));
  INFO(outcome.output);
  CHECK(outcome.exit_code == 0);
  for (const auto& e : errors(recording_in(folder / "run"), "sim", "joint_target", 2)) {
    std::cout << "busy machine: " << e.joint << " " << e.rms_rad / degree << "° RMS, "
              << e.largest_rad / degree << "° at most\n";
    CHECK(e.rms_rad < run.allowed_deg * degree);
  }
}
