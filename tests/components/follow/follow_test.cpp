#include <catch2/catch.hpp>

#include "components/force_control/force_control.hpp"
#include "components/length_control/length_control.hpp"

namespace {

erp::Robot rig() { return erp::read_robot(ERP_SOURCE_DIR "/configs/hinge_rig/robot.xml"); }

erp::SensorFrame frame_with(double shaft_rad, double tension_N) {
  erp::SensorFrame frame;
  erp::ActuatorSample sample{};
  erp::assign(sample.name, "flexor");
  sample.valid = erp::valid::all;
  sample.shaft_rad = shaft_rad, sample.tension_N = tension_N;
  erp::append(frame.actuators, sample);
  return frame;
}

node::Latest<erp::ActuatorTarget> target_of(erp::Mode mode, double reference) {
  node::Latest<erp::ActuatorTarget> target;
  target.received = true;
  erp::ActuatorReference desired{};
  erp::assign(desired.name, "flexor");
  desired.mode = static_cast<std::uint8_t>(mode), desired.reference = reference;
  erp::append(target.message.actuators, desired);
  return target;
}

erp::ActuatorReference only_reference(const std::optional<erp::ActuatorCommand>& command) {
  REQUIRE(command);
  REQUIRE(command->actuators._length == 1);
  return command->actuators._buffer[0];
}

}  // namespace

TEST_CASE("with where=\"ecu\" a target is passed on unchanged") {
  ForceControl control({}, rig());
  const auto sent =
      only_reference(control.step(frame_with(0, 5), 0.002, target_of(erp::Mode::force, 20)));
  CHECK(sent.mode == static_cast<std::uint8_t>(erp::Mode::force));
  CHECK(sent.reference == 20);
}

TEST_CASE("on the host the length law winds a line that is too long, within the current limit") {
  LengthControl control({.where = follow::Where::host}, rig());
  const auto small_error =
      only_reference(control.step(frame_with(0, 5), 0.002, target_of(erp::Mode::length, -1e-5)));
  CHECK(small_error.mode == static_cast<std::uint8_t>(erp::Mode::voltage));
  CHECK(small_error.reference > 0);
  // With a large error at rest the current limit of 4 A allows R i = 0.516 · 4 V.
  const auto large_error =
      only_reference(control.step(frame_with(0, 5), 0.002, target_of(erp::Mode::length, -0.1)));
  CHECK(large_error.reference == Approx(0.516 * 4).epsilon(1e-5));
}

TEST_CASE("on the host the force law gives positive voltage below its reference, negative above") {
  ForceControl control({.where = follow::Where::host}, rig());
  const auto below =
      only_reference(control.step(frame_with(0, 10), 0.002, target_of(erp::Mode::force, 20)));
  const auto above =
      only_reference(control.step(frame_with(0, 30), 0.002, target_of(erp::Mode::force, 20)));
  CHECK(below.reference > 0);
  CHECK(above.reference < 0);
}

TEST_CASE("a missing target or one older than 0.1 s gives no command") {
  ForceControl control({}, rig());
  CHECK_FALSE(control.step(frame_with(0, 5), 0.002, {}));
  auto stale = target_of(erp::Mode::force, 20);
  stale.age_s = 0.11;
  CHECK_FALSE(control.step(frame_with(0, 5), 0.002, stale));
}

TEST_CASE("an unmeasured actuator or a target of another mode is omitted from the command") {
  ForceControl control({}, rig());
  auto frame = frame_with(0, 5);
  frame.actuators._buffer[0].valid = 0;
  CHECK(control.step(frame, 0.002, target_of(erp::Mode::force, 20))->actuators._length == 0);
  CHECK(control.step(frame_with(0, 5), 0.002, target_of(erp::Mode::length, 0))->actuators._length ==
        0);
}
