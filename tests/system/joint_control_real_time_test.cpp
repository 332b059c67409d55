// Joint controllers in real time: with a plant that is killed during motion, and on an overloaded
// machine.
#include <atomic>

#include "components/node/real_time.hpp"
#include "tests/stalls.hpp"
#include "tests/system/background.hpp"
#include "tests/system/joint_runs.hpp"

using namespace tests;

namespace {

/// Keeps all cores busy: one thread more than the machine has cores.
class CpuLoad {
 public:
  CpuLoad() {
    for (unsigned k = 0; k < std::thread::hardware_concurrency() + 1; ++k)
      threads_.emplace_back([this] {
        while (!end_) {
        }
      });
  }
  ~CpuLoad() {
    end_ = true;
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  std::atomic<bool> end_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace

TEST_CASE("after the plant is killed and restarted, the joint errors return below their limits") {
  const JointRun run = joint_run();
  CAPTURE(run.graph);
  in_real_time([&] {
    const Folder folder;
    Background graph({"launch", "launch/" + run.graph + ".xml", "--out", folder / "run"},
                     folder / "run.txt");
    REQUIRE(graph.wait_for_output("all components are active"));
    std::this_thread::sleep_for(3s);
    const pid_t plant = graph.child("plant");
    REQUIRE(plant > 0);
    kill(plant, SIGKILL);
    std::this_thread::sleep_for(9s);
    CHECK(graph.stop() == 0);
    Findings findings = error_findings(run.graph + ", plant killed", recording_in(folder / "run"),
                                       9, run.allowed_deg + 0.5);
    if (!findings.empty()) findings.push_back(graph.output());
    return findings;
  });
}

TEST_CASE(
    "on an overloaded machine with real-time priority the joint errors stay below their limits") {
  REQUIRE(node::may_run_in_real_time());  // as root, or with ulimit -r 20
  const JointRun run{"puller_follower_twin", 12, 1.5};
  const CpuLoad load;
  in_real_time([&] {
    const Folder folder;
    const auto outcome = tests::run("erp launch launch/" + run.graph + ".xml --for " +
                                    std::to_string(run.for_s) + "s --out " + (folder / "run"));
    INFO(outcome.output);
    CHECK(outcome.exit_code == 0);
    return error_findings(run.graph + ", machine busy", recording_in(folder / "run"), 2,
                          run.allowed_deg);
  });
}
