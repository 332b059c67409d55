#include "sim/gap/residuals/noise_floor.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "sim/gap/residuals/signal_noise.hpp"
#include "tests/sim/gap/residuals/rig_recording.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::residuals;

TEST_CASE(
    "a window with a fast tension has a higher noise floor than one with a constant tension") {
  const erp::Robot robot = erp::read_robot(rigs::config("hinge_rig/robot.xml"));
  const Episode episode = rig_recording::record(robot, robot, {.seconds = 4});
  Stages stages(robot);
  const auto explained = stages.explain(episode);
  const auto stage_floors = floors(stages, episode, robot);
  const auto tendon = std::ranges::find_if(explained.residuals, [](const Residual& r) {
    return r.stage == sim::effects::Stage::tendon && r.on == "flexor";
  });
  const Floor& floor = stage_floors[std::size_t(tendon - explained.residuals.begin())];
  const Signal& tension = episode.actuators[0].tension_N;
  double fastest = 0, slowest = 1e9, floor_at_fastest = 0, floor_at_slowest = 0;
  for (std::size_t k = 0; k < floor.by_window.size(); ++k) {
    const std::size_t row = explained.rows[k];
    const double rate = std::abs(tension[row + 10] - tension[row - 10]);
    if (rate > fastest) fastest = rate, floor_at_fastest = floor.by_window[k];
    if (rate < slowest) slowest = rate, floor_at_slowest = floor.by_window[k];
  }
  CHECK(floor_at_fastest > floor_at_slowest);
  CHECK(floor_at_slowest == floor.rms);
}

TEST_CASE("the noise of a moving signal is estimated within 35 % from its third differences") {
  Signal slow;
  for (int k = 0; k < 2000; ++k) slow.push_back(std::sin(0.01 * k) + 0.01 * std::sin(37.0 * k * k));
  CHECK(noise_of(slow) == Approx(0.01 / std::numbers::sqrt2).epsilon(0.35));
  CHECK(rms({3, recording::not_taken, -3}) == 3);
  CHECK(rms({}) == 0);
}
