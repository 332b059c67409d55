#include "launch/erp/run/frame_watch.hpp"

#include <catch2/catch.hpp>

using launch::FrameWatch;
using Change = launch::FrameWatch::Change;

namespace {

constexpr std::int64_t ns_per_ms = 1'000'000;

/// Heartbeats every 100 ms until `until_ms`, with frames until `frames_until_ms`. Returns the time
/// in ms of the first change to `change`; -1: none.
int first_change_ms(Change change, int until_ms, int frames_until_ms, int frames_again_ms = 1 << 30,
                    bool running = true) {
  FrameWatch watch;
  std::uint64_t steps = 0;
  int found_ms = -1;
  for (int now_ms = 0; now_ms < until_ms; now_ms += 100) {
    if (now_ms < frames_until_ms || now_ms >= frames_again_ms) steps += 50;
    watch.on_heartbeat(steps, now_ms * ns_per_ms);
    if (watch.update(running, now_ms * ns_per_ms) == change && found_ms < 0) found_ms = now_ms;
  }
  return found_ms;
}

}  // namespace

TEST_CASE("frames that stop are reported within 1 s of the last one") {
  CHECK(first_change_ms(Change::stopped, 5000, 2000) == 2800);
}

TEST_CASE("frames that resume are reported with the next heartbeat") {
  CHECK(first_change_ms(Change::resumed, 5000, 2000, 4000) == 4000);
}

TEST_CASE("a component that ends while frames are missing is not a return of frames") {
  FrameWatch watch;
  watch.update(true, 0);
  REQUIRE(watch.update(true, 900 * ns_per_ms) == Change::stopped);
  CHECK(watch.update(false, 1000 * ns_per_ms) == Change::none);
  CHECK(watch.update(true, 1100 * ns_per_ms) == Change::none);
}

TEST_CASE("frames every 100 ms, or a process that does not run, are not reported") {
  CHECK(first_change_ms(Change::stopped, 5000, 5000) == -1);
  CHECK(first_change_ms(Change::stopped, 5000, 2000, 1 << 30, false) == -1);
}
