// Rate limits of references, from robot.xml.
#include <catch2/catch.hpp>
#include <vector>

#include "tests/components/plant/bench.hpp"

namespace {

using bench::Bench;
using bench::ms;
using bench::one_muscle;

/// The set-points sent to the ECU, one per 2 ms, while `mode` is commanded with `reference`.
std::vector<int> setpoints_of(Bench& bench, erp::Mode mode, double reference, int ticks) {
  std::vector<int> setpoints;
  for (int k = 0; k < ticks; ++k) {
    bench.now_ns += 2 * ms;
    bench.command("a", 0, mode, reference);
    bench.ecu_reports(ECU_STATE_RUNNING);
    setpoints.push_back(bench.request().setpoint);
  }
  return setpoints;
}

}  // namespace

TEST_CASE("a rate limiter moves at its rate in both directions and stops at the target") {
  plant::RateLimiter limiter;
  limiter.reset(1);
  CHECK(limiter.step(2, 100, 0.002) == Approx(1.2));
  CHECK(limiter.step(0, 100, 0.002) == Approx(1.0));
  CHECK(limiter.step(1.1, 100, 0.002) == 1.1);
  CHECK(limiter.step(50, plant::RateLimiter::unlimited, 0.002) == 50);
  CHECK(limiter.step(0, 100, 0) == 50);
}

TEST_CASE("a force reference rises at the actuator's tension rate of 500 N/s") {
  erp::Robot robot = one_muscle();
  robot.actuators[0].max_tension_rate_N_per_s = 500;
  Bench limited(robot), unlimited;
  limited.run("a", erp::Mode::force, 20);
  unlimited.run("a", erp::Mode::force, 20);
  CHECK(setpoints_of(unlimited, erp::Mode::force, 60, 1)[0] == 60000);
  const auto setpoints = setpoints_of(limited, erp::Mode::force, 60, 100);
  CHECK(setpoints.front() < 45000);  // starts at the measured 40 N
  for (std::size_t k = 1; k < setpoints.size(); ++k)
    CHECK(setpoints[k] - setpoints[k - 1] <= 1001);  // 500 N/s for 2 ms, in mN
  CHECK(setpoints.back() == 60000);
}

TEST_CASE("a length reference moves at the actuator's line speed before and after it is reached") {
  erp::Robot robot = one_muscle();
  robot.actuators[0].max_line_speed_m_per_s = 0.01;
  Bench bench(robot);
  bench.run("a", erp::Mode::length, 0);
  const double counts_per_m = setpoints_of(bench, erp::Mode::length, -0.002, 200).back() / 0.002;
  const auto return_setpoints = setpoints_of(bench, erp::Mode::length, 0, 200);
  REQUIRE(counts_per_m > 1e5);
  for (std::size_t k = 1; k < return_setpoints.size(); ++k)
    CHECK(return_setpoints[k - 1] - return_setpoints[k] <= 0.01 * 0.002 * counts_per_m + 1);
  CHECK(return_setpoints[50] > 0);
  CHECK(return_setpoints.back() == 0);
}
