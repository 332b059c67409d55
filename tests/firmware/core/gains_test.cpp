#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/firmware/core/channel.hpp"

using namespace firmware;

namespace {
const float not_a_number = std::numeric_limits<float>::quiet_NaN();
const float infinity = std::numeric_limits<float>::infinity();

bool are_in_effect(const ecu_channel& channel, const Gains& gains) {
  return std::equal(gains.begin(), gains.end(), channel.gains);
}
}  // namespace

TEST_CASE("a channel leaves boot only after every gain has been written") {
  for (unsigned missing = 0; missing < ECU_PARAMETER_COUNT; ++missing) {
    INFO("missing parameter " << missing);
    ecu_channel channel = in_state(ECU_STATE_BOOT);
    const Gains gains = rig_gains();
    bool accepted = false;
    const unsigned last =
        missing == ECU_PARAMETER_COUNT - 1 ? missing - 1 : ECU_PARAMETER_COUNT - 1;
    for (std::uint8_t i = 0; i < ECU_PARAMETER_COUNT; ++i)
      if (i != missing) accepted = ecu_parameter(&channel, i, gains[i], i == last);
    CHECK_FALSE(accepted);
    CHECK(channel.state == ECU_STATE_BOOT);
    CHECK(channel.rejected_commits == 1);
    CHECK(load(channel, gains));
    CHECK(channel.state == ECU_STATE_IDLE);
  }
}

TEST_CASE("an incomplete gain set has no effect") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  const Gains before = rig_gains();
  for (std::uint8_t i = 0; i + 1 < ECU_PARAMETER_COUNT; ++i) {
    CHECK(ecu_parameter(&channel, i, before[i] * 1.5f, false));
    tick(channel);
    CHECK(are_in_effect(channel, before));
  }
}

TEST_CASE(
    "a value that is not a number invalidates its set: the commit is refused, no value is kept") {
  for (float bad : {not_a_number, infinity, -infinity}) {
    ecu_channel channel = in_state(ECU_STATE_IDLE);
    const Gains before = rig_gains();
    CHECK(ecu_parameter(&channel, ECU_PARAMETER_LENGTH_KP, 10, false));
    CHECK_FALSE(ecu_parameter(&channel, ECU_PARAMETER_CURRENT_KP, bad, false));
    CHECK_FALSE(ecu_parameter(&channel, ECU_PARAMETER_CURRENT_KI, 7, true));
    CHECK(are_in_effect(channel, before));
    CHECK(ecu_parameter(&channel, ECU_PARAMETER_CURRENT_KI, 50, true));
    CHECK(channel.gains[ECU_PARAMETER_CURRENT_KI] == 50);
    CHECK(channel.gains[ECU_PARAMETER_LENGTH_KP] == before[ECU_PARAMETER_LENGTH_KP]);
  }
}

TEST_CASE("a parameter that does not exist is refused") {
  ecu_channel channel = in_state(ECU_STATE_IDLE);
  CHECK_FALSE(ecu_parameter(&channel, ECU_PARAMETER_COUNT, 1, true));
  CHECK_FALSE(ecu_parameter(&channel, 255, 1, false));
}

TEST_CASE("an implausible set of gains is refused") {
  const std::pair<ecu_parameter_index, float> implausible[] = {
      {ECU_PARAMETER_SUPPLY, 0},
      {ECU_PARAMETER_SUPPLY, -12},
      {ECU_PARAMETER_SHAFT_SCALE, 0},
      {ECU_PARAMETER_CURRENT_SCALE, -0.004f},
      {ECU_PARAMETER_CURRENT_COUNTS_MAX, 0},
      {ECU_PARAMETER_TENSION_SCALE, 0},
      {ECU_PARAMETER_TENSION_COUNTS_MAX, -1},
      {ECU_PARAMETER_RESISTANCE, 0},
      {ECU_PARAMETER_BACK_EMF, -1},
      {ECU_PARAMETER_CURRENT_LIMIT, 0},
      {ECU_PARAMETER_CURRENT_TRIP, 3.9f},
      {ECU_PARAMETER_TENSION_LIMIT, 0},
      {ECU_PARAMETER_TENSION_TRIP, 149},
      {ECU_PARAMETER_SHAFT_MIN, 20},
      {ECU_PARAMETER_SHAFT_MAX, -20},
      {ECU_PARAMETER_LENGTH_KP, -1},
      {ECU_PARAMETER_CURRENT_KP, -1},
      {ECU_PARAMETER_CURRENT_KI, -1},
      {ECU_PARAMETER_CURRENT_KD, -1},
  };
  for (const auto& [index, value] : implausible) {
    INFO("parameter " << index << " = " << value);
    Gains gains = rig_gains();
    gains[index] = value;
    ecu_channel channel = in_state(ECU_STATE_BOOT);
    CHECK_FALSE(load(channel, gains));
    CHECK(channel.state == ECU_STATE_BOOT);
  }
}

TEST_CASE("gains can be changed while running, and the next tick uses them") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  const auto setpoint = std::int32_t(0.01f / rig_gains()[ECU_PARAMETER_SHAFT_SCALE]);
  REQUIRE(ecu_command(&channel, ECU_REQUEST_LENGTH, setpoint));
  const auto before = tick(channel);
  REQUIRE(ecu_parameter(&channel, ECU_PARAMETER_LENGTH_KP, 80, true));
  CHECK(channel.state == ECU_STATE_RUNNING);
  CHECK(tick(channel) == Approx(2 * before).margin(1));
}

TEST_CASE("new current gains do not change the voltage of a settled loop") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  const ecu_inputs one_ampere{0, 256, 0};
  REQUIRE(tick(channel, one_ampere) != 0);
  REQUIRE(ecu_command(&channel, ECU_REQUEST_CURRENT, 1000));
  for (int i = 0; i < 10; ++i) tick(channel, one_ampere);
  const auto before = tick(channel, one_ampere);
  REQUIRE(before > 0);
  REQUIRE(ecu_parameter(&channel, ECU_PARAMETER_CURRENT_KP, 2, false));
  REQUIRE(ecu_parameter(&channel, ECU_PARAMETER_CURRENT_KI, 500, true));
  CHECK(tick(channel, one_ampere) == before);
}
