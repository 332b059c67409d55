#include "launch/erp/run/status_table.hpp"

#include <catch2/catch.hpp>

using Catch::Matchers::Contains;

TEST_CASE("a duration is shown in µs, ms or s according to its size") {
  CHECK(launch::microseconds(0) == "-");
  CHECK(launch::microseconds(85) == "85 µs");
  CHECK(launch::microseconds(1310) == "1.3 ms");
  CHECK(launch::microseconds(2.5e6) == "2.5 s");
}

TEST_CASE("the head of the table has device time and remaining time") {
  launch::Status status{.graph = "rig", .device = "sim", .time = "lockstep", .stage = "running"};
  status.elapsed_s = 2, status.device_s = 8, status.remaining_s = 3;
  status.rows.push_back({.name = "plant", .state = "active", .pid = 7, .rate_Hz = 500});
  const auto lines = launch::render(status);
  REQUIRE(lines.size() == 3);
  CHECK_THAT(lines[0], Contains("device at 8.00 s") && Contains("3.00 s left"));
  CHECK_THAT(lines[2], Contains("plant") && Contains("active") && Contains("500 Hz"));
}
