#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/firmware/core/channel.hpp"

using namespace firmware;

namespace {

constexpr std::int32_t raw = 1000, added = 500000;

ecu_inputs at(std::int32_t counts) {
  ecu_inputs inputs{};
  inputs.encoder_counts = counts;
  return inputs;
}

/// A channel whose encoder stands at `raw` counts since the reset.
ecu_channel standing(ecu_state state, const Gains& gains = rig_gains()) {
  ecu_channel channel = in_state(state, gains);
  tick(channel, at(raw));
  tick(channel, at(raw));
  return channel;
}

}  // namespace

TEST_CASE("after a reset the zero of the encoder is unknown") {
  ecu_channel channel = standing(ECU_STATE_IDLE);
  CHECK_FALSE(channel.zero_known);
  CHECK(channel.sensed.inputs.encoder_counts == raw);
}

TEST_CASE("a zero shifts the position, not the speed, and is kept until the next reset") {
  for (const auto state : {ECU_STATE_BOOT, ECU_STATE_IDLE, ECU_STATE_ARMED, ECU_STATE_RUNNING}) {
    ecu_channel channel = standing(state);
    CHECK(ecu_parameter(&channel, ECU_ZERO, added, false));
    CHECK(channel.zero_known);
    CHECK(channel.sensed.inputs.encoder_counts == raw + added);
    tick(channel, at(raw + 3));
    CHECK(channel.sensed.inputs.encoder_counts == raw + added + 3);
    if (state == ECU_STATE_BOOT) continue;  // without gains there are no SI values
    const float scale = rig_gains()[ECU_PARAMETER_SHAFT_SCALE];
    CHECK(channel.sensed.shaft_rad == Approx((raw + added + 3) * scale));
    CHECK(channel.sensed.speed_rad_per_s == Approx(3 * scale / 0.002f));
    ecu_init(&channel);
    CHECK_FALSE(channel.zero_known);
  }
}

TEST_CASE("the same zero twice has no further effect; not a number makes it unknown") {
  ecu_channel channel = standing(ECU_STATE_IDLE);
  for (int i = 0; i < 3; ++i) ecu_parameter(&channel, ECU_ZERO, added, false);
  CHECK(channel.sensed.inputs.encoder_counts == raw + added);
  CHECK(ecu_parameter(&channel, ECU_ZERO, std::numeric_limits<float>::quiet_NaN(), false));
  CHECK_FALSE(channel.zero_known);
  CHECK(channel.sensed.inputs.encoder_counts == raw);
}

TEST_CASE("a zero is refused while a length set-point is followed, and beyond its range") {
  ecu_channel channel = standing(ECU_STATE_RUNNING);
  CHECK_FALSE(ecu_parameter(&channel, ECU_ZERO, 9e6f, false));
  CHECK_FALSE(channel.zero_known);
  ecu_command(&channel, ECU_REQUEST_LENGTH, raw);
  CHECK_FALSE(ecu_parameter(&channel, ECU_ZERO, added, false));
  CHECK_FALSE(channel.zero_known);
  CHECK(channel.sensed.inputs.encoder_counts == raw);
}

TEST_CASE("a zero is not part of a gain set") {
  ecu_channel channel = standing(ECU_STATE_IDLE);
  CHECK(ecu_parameter(&channel, ECU_PARAMETER_LENGTH_KP, 10, false));
  CHECK(ecu_parameter(&channel, ECU_ZERO, added, true));
  CHECK(channel.gains[ECU_PARAMETER_LENGTH_KP] == rig_gains()[ECU_PARAMETER_LENGTH_KP]);
  CHECK(ecu_parameter(&channel, ECU_PARAMETER_LENGTH_KP, 10, true));
  CHECK(channel.gains[ECU_PARAMETER_LENGTH_KP] == 10);
}

TEST_CASE("a zero does not trip the comparison of encoder and potentiometer") {
  ecu_channel channel = in_state(ECU_STATE_ARMED, fitted_gains());
  ecu_inputs inputs = at(raw);
  inputs.tension_counts = 500, inputs.temperature_counts = 600, inputs.supply_counts = 2400;
  inputs.potentiometer_counts = 2000;
  for (int i = 0; i < 200; ++i) {
    if (i == 50) ecu_set_zero(&channel, true, added);
    ecu_command(&channel, ECU_REQUEST_ARM, 0);
    tick(channel, inputs);
  }
  CHECK(channel.state == ECU_STATE_ARMED);
}
