#include "components/node/log_throttle.hpp"

#include <catch2/catch.hpp>

using node::LogThrottle;

TEST_CASE("three reports of a kind pass; later ones are counted until the window ends") {
  LogThrottle throttle;
  std::int64_t now_ns = 5;
  for (int k = 0; k < 3; ++k) CHECK(throttle.admit("flexor stale", now_ns += 1000) == 0U);
  for (int k = 0; k < 40; ++k) CHECK_FALSE(throttle.admit("flexor stale", now_ns += 1000));
  CHECK(throttle.admit("extensor stale", now_ns) == 0U);
  now_ns += LogThrottle::window_ns;
  CHECK(throttle.admit("flexor stale", now_ns) == 40U);
  CHECK(throttle.admit("flexor stale", now_ns) == 0U);
}
