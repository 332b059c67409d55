#include "components/node/real_time.hpp"

#include <catch2/catch.hpp>
#include <thread>

using node::RealTime;

namespace {

int policy() { return sched_getscheduler(0); }

}  // namespace

TEST_CASE("real-time priority goes over to threads that are started, and ends with its owner") {
  REQUIRE(node::may_run_in_real_time());  // as root, or with ulimit -r 20
  CHECK(policy() == SCHED_OTHER);
  int of_thread = -1;
  {
    const RealTime urgent(true);
    CHECK(urgent.on());
    CHECK(policy() == SCHED_FIFO);
    std::thread([&] { of_thread = policy(); }).join();
  }
  CHECK(of_thread == SCHED_FIFO);
  CHECK(policy() == SCHED_OTHER);
}

TEST_CASE("who does not want real-time priority keeps what it has") {
  const RealTime usual(false);
  CHECK_FALSE(usual.on());
  CHECK(policy() == SCHED_OTHER);
}
