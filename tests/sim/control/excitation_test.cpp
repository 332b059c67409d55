#include "sim/control/excitation.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/sim/rigs.hpp"

TEST_CASE("the posture range is reduced until every tendon has a path") {
  // In extreme postures of ecce4 a point of serratus is inside the adjacent pulley.
  const erp::Robot robot = erp::read_robot(rigs::config("ecce4/robot.xml"));
  for (int recording = 0; recording < 2; ++recording) {
    const auto excitation = sim::excitation(robot, recording, 2, 282001);
    REQUIRE(excitation.reference.size() == 1000);
    for (const auto& row : excitation.reference)
      CHECK(std::ranges::all_of(row, [](double v) { return std::isfinite(v); }));
  }
}
