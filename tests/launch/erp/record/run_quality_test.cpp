#include "launch/erp/record/run_quality.hpp"

#include <catch2/catch.hpp>

namespace {

erp::Robot hinge_rig() { return erp::read_robot(ERP_SOURCE_DIR "/configs/hinge_rig/robot.xml"); }

constexpr double off = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("shares of saturation and slack count only rows in which the ECU runs") {
  const recording::Table table{{{"time_s", {0, 1, 2, 3, 4}},
                                {"flexor.mode", {off, 4, 4, 4, 4}},
                                {"flexor.voltage_V", {12, 12, -12, 11, 3}},
                                {"flexor.tension_N", {0, 0.4, 10, 10, 10}}}};
  const auto loads = launch::actuator_loads(table, hinge_rig());
  REQUIRE(loads.size() == 2);
  CHECK(loads[0].actuator == "flexor");
  CHECK(loads[0].saturated == Approx(0.5));
  CHECK(loads[0].slack == Approx(0.25));
  CHECK(loads[1].saturated == 0);  // not in the recording
}
