#include "components/node/real_time.hpp"

#include <catch2/catch.hpp>
#include <thread>

using node::RealTimePriority;

namespace {

int policy() { return sched_getscheduler(0); }

}  // namespace

TEST_CASE("started threads inherit real-time priority, and the priority ends with its object") {
  REQUIRE(node::may_run_in_real_time());  // as root, or with ulimit -r 20
  CHECK(policy() == SCHED_OTHER);
  int thread_policy = -1;
  {
    const RealTimePriority priority(true);
    CHECK(priority.on());
    CHECK(policy() == SCHED_FIFO);
    std::thread([&] { thread_policy = policy(); }).join();
  }
  CHECK(thread_policy == SCHED_FIFO);
  CHECK(policy() == SCHED_OTHER);
}

TEST_CASE("without real-time priority enabled the scheduling policy does not change") {
  const RealTimePriority priority(false);
  CHECK_FALSE(priority.on());
  CHECK(policy() == SCHED_OTHER);
}
