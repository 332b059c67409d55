#include "sim/residuals/units.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "tests/sim/residuals/rig_recording.hpp"
#include "tests/sim/rigs.hpp"

using sim::residuals::Episode;
using sim::residuals::Signal;

namespace {

erp::Robot hinge_rig() { return erp::read_robot(rigs::config("hinge_rig/robot.xml")); }

/// What is odd about a recording of the rig after such a change.
template <class Change>
std::vector<std::string> odd_after(Change change) {
  static const Episode plain = rig_recording::record(hinge_rig(), hinge_rig(), {.seconds = 8});
  Episode episode = plain;
  change(episode);
  return sim::residuals::odd_units(episode, hinge_rig());
}

void scale(Signal& signal, double by) {
  for (double& x : signal) x *= by;
}

void check_says(const std::vector<std::string>& odd, const char* column, const char* what) {
  REQUIRE_FALSE(odd.empty());
  CHECK_THAT(odd[0], Catch::Contains(column) && Catch::Contains(what));
}

}  // namespace

TEST_CASE("a recording of the rig has the signs and units that its laws foretell") {
  CHECK(odd_after([](Episode&) {}).empty());
}

TEST_CASE("wrong signs and units are told with what they look like") {
  const double degrees = 180 / std::numbers::pi;
  check_says(odd_after([&](Episode& e) { scale(e.actuators[0].shaft_rad, degrees); }),
             "flexor.shaft_rad", "degrees");
  check_says(odd_after([&](Episode& e) { scale(e.actuators[0].shaft_rad, 128); }),
             "flexor.shaft_rad", "before the gearbox");
  check_says(odd_after([&](Episode& e) { scale(e.actuators[1].shaft_rad, -1); }),
             "extensor.shaft_rad", "sign");
  check_says(odd_after([&](Episode& e) { scale(e.actuators[0].current_A, 1000); }),
             "flexor.current_A", "thousandths");
  check_says(odd_after([&](Episode& e) { scale(e.actuators[1].current_A, -1); }),
             "extensor.current_A", "sign");
  check_says(odd_after([&](Episode& e) { scale(e.actuators[0].tension_N, -1); }),
             "flexor.tension_N", "sign");
  check_says(odd_after([&](Episode& e) { scale(e.actuators[0].tension_N, 1 / 9.81); }),
             "flexor.tension_N", "kilograms");
  check_says(odd_after([&](Episode& e) { scale(e.joints[0].angle_rad, -1); }), "flexor crosses",
             "sign");
  check_says(odd_after([&](Episode& e) { scale(e.joints[0].angle_rad, degrees); }), "", "degrees");
}

TEST_CASE("what is a third too small looks like no unit, and a shaft's sign is told once") {
  CHECK(odd_after([](Episode& e) { scale(e.actuators[0].tension_N, 0.3); }).empty());
  CHECK(odd_after([](Episode& e) { scale(e.actuators[0].tension_N, 0.01); }).size() == 1);
  CHECK(odd_after([](Episode& e) { scale(e.actuators[1].shaft_rad, -1); }).size() == 1);
}
