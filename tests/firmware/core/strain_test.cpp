#include <catch2/catch.hpp>

#include "tests/firmware/core/channel.hpp"

// Load limits of a motor and its ECU.
using namespace firmware;

namespace {

constexpr std::uint16_t warm_counts = 600, supply_counts = 2400;  // 20 degrees, 12 V

struct Loaded {
  ecu_channel channel = in_state(ECU_STATE_RUNNING, fitted_gains());

  /// Returns the tick of the trip, 0: no trip.
  int trip_tick(int ticks, float current_A, std::uint16_t temperature = warm_counts,
                std::uint16_t supply = supply_counts) {
    const float scale = fitted_gains()[ECU_PARAMETER_CURRENT_SCALE];
    for (int k = 1; k <= ticks; ++k) {
      ecu_command(&channel, ECU_REQUEST_VOLTAGE, 1000);
      tick(channel, {0, std::int16_t(current_A / scale), 500, 2000, temperature, supply});
      if (channel.state == ECU_STATE_FAULT) return k;
    }
    return 0;
  }
};

}  // namespace

TEST_CASE("the continuous current does not trip; twice the continuous current trips after 2 s") {
  Loaded motor;
  CHECK(motor.trip_tick(5000, 1.99f) == 0);
  const int ticks = motor.trip_tick(2000, 4);  // 24 A2 s / (16 - 4) A2
  CHECK(ticks * 0.002 == Approx(2).epsilon(0.01));
  CHECK(motor.channel.fault == ECU_FAULT_OVERLOAD);
}

TEST_CASE("after a cleared overload the motor trips again until it has cooled") {
  Loaded motor;
  motor.trip_tick(2000, 4);
  ecu_command(&motor.channel, ECU_REQUEST_CLEAR, motor.channel.fault);
  CHECK(motor.trip_tick(10, 4) == 1);
  ecu_command(&motor.channel, ECU_REQUEST_CLEAR, motor.channel.fault);
  CHECK(motor.trip_tick(3000, 0) == 1);  // still above the limit at the first tick
  for (int k = 0; k < 3000; ++k) tick(motor.channel, {0, 0, 500, 2000, warm_counts, supply_counts});
  ecu_command(&motor.channel, ECU_REQUEST_CLEAR, motor.channel.fault);
  CHECK(motor.trip_tick(500, 0) == 0);
}

TEST_CASE(
    "the current limit decreases with temperature, and above the trip level the channel trips "
    "after 100 ms") {
  const auto counts = [](float temperature_C) { return std::uint16_t((temperature_C + 40) * 10); };
  const Gains gains = fitted_gains();
  const auto limit_A = [&](float temperature_C) {
    const ecu_inputs inputs{.temperature_counts = counts(temperature_C)};
    return ecu_current_limit_A(gains.data(), &inputs);
  };
  CHECK(limit_A(70) == 4);
  CHECK(limit_A(90) == Approx(2));
  CHECK(limit_A(110) == 0);
  ecu_channel heated = in_state(ECU_STATE_RUNNING, gains);
  ecu_command(&heated, ECU_REQUEST_VOLTAGE, 12000);
  const float duty = tick(heated, {0, 0, 500, 2000, counts(90), supply_counts});
  CHECK(duty / ECU_DUTY_MAX * 12 / 0.516f == Approx(2).epsilon(0.01));
  Loaded motor;
  CHECK(motor.trip_tick(200, 0, counts(99)) == 0);
  CHECK(motor.trip_tick(49, 0, counts(101)) == 0);
  CHECK(motor.trip_tick(200, 0, counts(99)) == 0);
  CHECK(motor.trip_tick(200, 0, counts(101)) == 50);
  CHECK(motor.channel.fault == ECU_FAULT_OVER_TEMPERATURE);
}

TEST_CASE("a low supply trips after 10 ms, not before") {
  Loaded motor;
  CHECK(motor.trip_tick(4, 0, warm_counts, 1700) == 0);
  CHECK(motor.trip_tick(1, 0) == 0);
  CHECK(motor.trip_tick(20, 0, warm_counts, 1700) == 5);
  CHECK(motor.channel.fault == ECU_FAULT_SUPPLY);
}

TEST_CASE("sensors that are not fitted are not checked") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  for (int k = 0; k < 1000; ++k) {
    ecu_command(&channel, ECU_REQUEST_VOLTAGE, 1000);
    CHECK(tick(channel, {0, 1000, 0}) != 0);
  }
}

TEST_CASE("the third consecutive overrun control period trips, two do not") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  for (const bool overran : {true, true, false, true, true}) ecu_overran(&channel, overran);
  CHECK(channel.state == ECU_STATE_RUNNING);
  CHECK(channel.overruns == 4);
  ecu_overran(&channel, true);
  CHECK(channel.fault == ECU_FAULT_OVERRUN);
  CHECK(tick(channel) == 0);
}
