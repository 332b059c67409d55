#include "launch/erp/run/run_time.hpp"

#include <catch2/catch.hpp>

constexpr std::int64_t s = 1'000'000'000;

TEST_CASE("a run in real time is over when its duration has passed since activation") {
  launch::RunTime time(5, false);
  time.start(10 * s);
  time.tick(12 * s);
  CHECK(time.remaining_s() < 0);
  time.running();
  time.tick(14 * s);
  time.running();
  CHECK(time.elapsed_s() == 4);
  CHECK(time.remaining_s() == 3);
  CHECK_FALSE(time.is_over());
  time.tick(17 * s);
  CHECK(time.is_over());
}

TEST_CASE("the device time continues after a restart of the device") {
  launch::RunTime time(0, false);
  CHECK(time.device_s() < 0);
  for (const auto stamp_ns : {2 * s, 3 * s, 0 * s, 2 * s}) time.on_device_clock(stamp_ns, 1);
  CHECK(time.device_s() == 3);
}

TEST_CASE(
    "in lockstep the remaining time follows from the real-time factor, and real time does not end "
    "the run") {
  launch::RunTime time(10, true);
  time.start(0);
  time.running();
  time.on_device_clock(0, 4), time.on_device_clock(6 * s, 4);
  CHECK(time.remaining_s() == 1);
  time.tick(100 * s);
  CHECK_FALSE(time.is_over());
}
