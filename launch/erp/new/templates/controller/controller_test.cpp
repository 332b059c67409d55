#define CATCH_CONFIG_MAIN
#include "@name@.hpp"

#include <catch2/catch.hpp>

namespace {

erp::SensorFrame frame_with(const char* actuator, double tension_N) {
  erp::SensorFrame frame;
  auto& sample = erp::append(frame.actuators, erp::ActuatorSample{});
  erp::assign(sample.name, actuator);
  sample.tension_N = tension_N;
  return frame;
}

}  // namespace

TEST_CASE("at the reference tension the command is the reference") {
  @Class@ controller({.tension_N = 20.0, .gain = 0.5});
  const auto command = controller.step(frame_with("flexor", 20.0), 0.002);
  REQUIRE(command.actuators._length == 1);
  CHECK(std::string(command.actuators._buffer[0].name) == "flexor");
  CHECK(command.actuators._buffer[0].reference == Approx(20.0));
}

TEST_CASE("below the reference tension the command is higher than the reference") {
  @Class@ controller({.tension_N = 20.0, .gain = 0.5});
  const auto command = controller.step(frame_with("flexor", 10.0), 0.002);
  CHECK(command.actuators._buffer[0].reference == Approx(25.0));
}
