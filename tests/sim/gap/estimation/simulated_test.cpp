#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "sim/gap/estimation/as_built.hpp"
#include "tests/sim/gap/residuals/rig_recording.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::estimation;

TEST_CASE("calibration of a simulated robot gives the constants of the simulation") {
  const erp::Robot robot = erp::read_robot(rigs::config("hinge_rig/robot.xml"));
  std::vector<sim::residuals::Episode> recordings;
  for (const std::uint64_t seed : {1, 2})
    recordings.push_back(rig_recording::record(
        robot, robot, {.swing_N = 10.0 + 4 * double(seed), .ripple_Hz = 2.5, .seed = seed}));
  const AsBuilt found = calibrated(robot, recordings);
  CHECK(found.beyond_tolerance.empty());
  for (std::size_t k = 0; k < found.uncertain.constants.size(); ++k) {
    const Constant& c = found.uncertain.constants[k];
    INFO(c.on << " " << c.name << " " << c.value(found.estimate.point.x[k]) << ", "
              << found.estimate.point.x[k] << " +- " << found.estimate.sigma(k) << " tolerances");
    CHECK(std::abs(found.estimate.point.x[k]) < 2.6 * found.estimate.sigma(k) + 0.1);
  }
}
