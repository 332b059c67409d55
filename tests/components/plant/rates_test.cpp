// References that move no faster than robot.xml allows.
#include <catch2/catch.hpp>
#include <vector>

#include "tests/components/plant/bench.hpp"

namespace {

using bench::Bench;
using bench::ms;
using bench::one_muscle;

/// What is asked of the ECU each 2 ms while `mode` is commanded at `reference`.
std::vector<int> asked(Bench& bench, erp::Mode mode, double reference, int ticks) {
  std::vector<int> setpoints;
  for (int k = 0; k < ticks; ++k) {
    bench.now_ns += 2 * ms;
    bench.says("a", 0, mode, reference);
    bench.ecu_says(ECU_STATE_RUNNING);
    setpoints.push_back(bench.asks().setpoint);
  }
  return setpoints;
}

}  // namespace

TEST_CASE("a slew goes as fast as it may, both ways, and stops where it is wanted") {
  plant::Slew slew;
  slew.start(1);
  CHECK(slew.towards(2, 100, 0.002) == Approx(1.2));
  CHECK(slew.towards(0, 100, 0.002) == Approx(1.0));
  CHECK(slew.towards(1.1, 100, 0.002) == 1.1);
  CHECK(slew.towards(50, plant::Slew::free, 0.002) == 50);
  CHECK(slew.towards(0, 100, 0) == 50);
}

TEST_CASE("a force reference rises by the actuator's rate") {
  erp::Robot robot = one_muscle();
  robot.actuators[0].max_tension_rate_N_per_s = 500;
  Bench slow(robot), free;
  slow.run("a", erp::Mode::force, 20);
  free.run("a", erp::Mode::force, 20);
  CHECK(asked(free, erp::Mode::force, 60, 1)[0] == 60000);
  const auto setpoints = asked(slow, erp::Mode::force, 60, 100);
  CHECK(setpoints.front() < 45000);  // from the 40 N that are measured
  for (std::size_t k = 1; k < setpoints.size(); ++k)
    CHECK(setpoints[k] - setpoints[k - 1] <= 1001);  // 500 N/s for 2 ms, in mN
  CHECK(setpoints.back() == 60000);
}

TEST_CASE("a length reference moves by the actuator's speed, before and after it was reached") {
  erp::Robot robot = one_muscle();
  robot.actuators[0].max_line_speed_m_per_s = 0.01;
  Bench bench(robot);
  bench.run("a", erp::Mode::length, 0);
  const double counts_per_m = asked(bench, erp::Mode::length, -0.002, 200).back() / 0.002;
  const auto back = asked(bench, erp::Mode::length, 0, 200);
  REQUIRE(counts_per_m > 1e5);
  for (std::size_t k = 1; k < back.size(); ++k)
    CHECK(back[k - 1] - back[k] <= 0.01 * 0.002 * counts_per_m + 1);
  CHECK(back[50] > 0);
  CHECK(back.back() == 0);
}
