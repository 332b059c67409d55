#include "components/node/damper.hpp"

#include <catch2/catch.hpp>

using node::Damper;

TEST_CASE("what is repeated is said three times, then counted until the window is over") {
  Damper damper;
  std::int64_t now_ns = 5;
  for (int k = 0; k < 3; ++k) CHECK(damper.admit("flexor stale", now_ns += 1000) == 0U);
  for (int k = 0; k < 40; ++k) CHECK_FALSE(damper.admit("flexor stale", now_ns += 1000));
  CHECK(damper.admit("extensor stale", now_ns) == 0U);
  now_ns += Damper::window_ns;
  CHECK(damper.admit("flexor stale", now_ns) == 40U);
  CHECK(damper.admit("flexor stale", now_ns) == 0U);
}
