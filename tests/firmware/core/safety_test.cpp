#include <catch2/catch.hpp>
#include <cstdlib>

#include "tests/firmware/core/channel.hpp"

using namespace firmware;

namespace {
ecu_inputs reading(float current_A, float tension_N) {
  const Gains g = rig_gains();
  return {0, std::int16_t(current_A / g[ECU_PARAMETER_CURRENT_SCALE]),
          std::uint16_t(tension_N / g[ECU_PARAMETER_TENSION_SCALE])};
}
}  // namespace

TEST_CASE("50 ms without a command sets PWM to 0") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  for (unsigned i = 0; i < 25; ++i) {
    INFO("tick " << i);
    CHECK(ecu_is_warning(&channel) == (i >= 10));
    CHECK(tick(channel) != 0);
  }
  CHECK(tick(channel) == 0);
  CHECK(channel.state == ECU_STATE_FAULT);
  CHECK(channel.fault == ECU_FAULT_COMMAND_TIMEOUT);
}

TEST_CASE("a command every 48 ms keeps a channel running") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  for (int i = 0; i < 240; ++i) {
    if (i % 24 == 0) REQUIRE(ecu_command(&channel, ECU_REQUEST_VOLTAGE, 1000));
    CHECK(tick(channel) != 0);
  }
}

TEST_CASE("a clear request does not reset the command timeout of a running channel") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  for (int i = 0; i < 26; ++i) ecu_command(&channel, ECU_REQUEST_CLEAR, 0), tick(channel);
  CHECK(channel.fault == ECU_FAULT_COMMAND_TIMEOUT);
}

TEST_CASE("a fault latches until it is cleared, and keeps its first cause") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  ecu_trip(&channel, ECU_FAULT_OVER_TENSION);
  ecu_trip(&channel, ECU_FAULT_CORRUPT);
  for (int i = 0; i < 1000; ++i) {
    for (int request : {0, 2, 3, 4, 5, 6, 7}) ecu_command(&channel, ecu_request(request), 1000);
    CHECK(tick(channel) == 0);
  }
  CHECK(channel.fault == ECU_FAULT_OVER_TENSION);
  CHECK_FALSE(
      ecu_command(&channel, ECU_REQUEST_CLEAR, ECU_FAULT_COMMAND_TIMEOUT));  // the previous fault
  CHECK(channel.state == ECU_STATE_FAULT);
  CHECK(ecu_command(&channel, ECU_REQUEST_CLEAR, ECU_FAULT_OVER_TENSION));
  CHECK(channel.state == ECU_STATE_IDLE);
  CHECK(channel.fault == ECU_FAULT_NONE);
}

TEST_CASE("after a fault the old set-point is discarded: PWM is 0 after the next arming") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  tick(channel);
  ecu_trip(&channel, ECU_FAULT_OVER_TENSION);
  ecu_command(&channel, ECU_REQUEST_CLEAR, channel.fault);
  ecu_command(&channel, ECU_REQUEST_ARM, 0);
  CHECK(tick(channel) == 0);
  CHECK(channel.setpoint == 0);
}

TEST_CASE("the current law starts after arming without the integral of the last run") {
  ecu_channel channel = in_state(ECU_STATE_ARMED);
  ecu_command(&channel, ECU_REQUEST_CURRENT, 1000);
  const auto first = tick(channel);
  for (int i = 0; i < 20; ++i) tick(channel);
  CHECK(tick(channel) > first);
  ecu_command(&channel, ECU_REQUEST_ARM, 0);
  tick(channel);
  ecu_command(&channel, ECU_REQUEST_CURRENT, 1000);
  CHECK(tick(channel) == first);
}

TEST_CASE("over-current trips at the second tick, not at the first") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  CHECK(tick(channel, reading(7, 0)) != 0);
  CHECK(tick(channel, reading(1, 0)) != 0);
  CHECK(tick(channel, reading(-7, 0)) != 0);
  CHECK(tick(channel, reading(-7, 0)) == 0);
  CHECK(channel.fault == ECU_FAULT_OVER_CURRENT);
}

TEST_CASE("a current converter at its rail trips as over-current") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  tick(channel, {0, 2047, 0});
  tick(channel, {0, 2047, 0});
  CHECK(channel.fault == ECU_FAULT_OVER_CURRENT);
}

TEST_CASE("over-tension trips at once") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  CHECK(tick(channel, reading(0, 179)) != 0);
  CHECK(tick(channel, reading(0, 181)) == 0);
  CHECK(channel.fault == ECU_FAULT_OVER_TENSION);
}

TEST_CASE("a force sensor at its rail trips at the third sample and is ignored before") {
  ecu_channel channel = in_state(ECU_STATE_ARMED);
  ecu_command(&channel, ECU_REQUEST_FORCE, 20000);
  const auto before = tick(channel, reading(0, 15));
  CHECK(tick(channel, {0, 0, 4095}) == before);
  CHECK(tick(channel, {0, 0, 4095}) == before);
  CHECK(tick(channel, {0, 0, 4095}) == 0);
  CHECK(channel.fault == ECU_FAULT_SENSOR_RANGE);
}

TEST_CASE("a fault whose cause persists trips again after a clear") {
  ecu_channel channel = in_state(ECU_STATE_IDLE);
  for (int i = 0; i < 3; ++i) tick(channel, {0, 0, 4095});
  REQUIRE(channel.state == ECU_STATE_FAULT);
  ecu_command(&channel, ECU_REQUEST_CLEAR, channel.fault);
  for (int i = 0; i < 3; ++i) tick(channel, {0, 0, 4095});
  CHECK(channel.state == ECU_STATE_FAULT);
}

TEST_CASE("set-points outside the limits are rejected; those at the limit are accepted") {
  struct Limit {
    ecu_request request;
    std::int32_t low, high;
  };
  const float scale = rig_gains()[ECU_PARAMETER_SHAFT_SCALE];
  const auto counts = std::int32_t(20 / scale);
  for (const Limit& limit :
       {Limit{ECU_REQUEST_VOLTAGE, -12000, 12000}, Limit{ECU_REQUEST_LENGTH, -counts, counts},
        Limit{ECU_REQUEST_CURRENT, -4000, 4000}, Limit{ECU_REQUEST_FORCE, 0, 150000}}) {
    INFO("request " << limit.request);
    ecu_channel channel = in_state(ECU_STATE_RUNNING);
    CHECK(ecu_command(&channel, limit.request, limit.low));
    CHECK(ecu_command(&channel, limit.request, limit.high));
    const auto beyond = limit.request == ECU_REQUEST_LENGTH ? 20 : 1;
    CHECK_FALSE(ecu_command(&channel, limit.request, limit.low - beyond));
    CHECK_FALSE(ecu_command(&channel, limit.request, limit.high + beyond));
    CHECK_FALSE(ecu_command(&channel, limit.request, INT32_MIN));
    CHECK_FALSE(ecu_command(&channel, limit.request, INT32_MAX));
    CHECK(channel.setpoint == limit.high);
    CHECK(channel.rejected_setpoints == 4);
  }
}

TEST_CASE("after a rejected set-point the old one remains in effect until it times out") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  for (int i = 0; i < 25; ++i) {
    if (i % 8 == 7) CHECK_FALSE(ecu_command(&channel, ECU_REQUEST_VOLTAGE, 13000));
    CHECK(tick(channel) != 0);
  }
  CHECK(tick(channel) == 0);
  CHECK(channel.fault == ECU_FAULT_COMMAND_TIMEOUT);
}

TEST_CASE("five consecutive invalid set-points trip; four and a valid one do not") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 4; ++i) ecu_command(&channel, ECU_REQUEST_FORCE, -1000);
    CHECK(ecu_command(&channel, ECU_REQUEST_VOLTAGE, 1000));
  }
  for (int i = 0; i < 5; ++i) ecu_command(&channel, ecu_request(7), 0);
  CHECK(channel.fault == ECU_FAULT_SETPOINT);
  CHECK(tick(channel) == 0);
}

TEST_CASE("the predictive current limit holds at standstill for any set-point") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  ecu_command(&channel, ECU_REQUEST_VOLTAGE, 12000);
  const float steady_A = float(tick(channel)) / ECU_DUTY_MAX * 12 / 0.516f;
  CHECK(steady_A == Approx(4).epsilon(0.01));
}

TEST_CASE(
    "the speed is the encoder difference over one period, also across the wrap of its counter") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  tick(channel, {INT32_MAX - 100, 0, 0});
  tick(channel, {INT32_MIN + 99, 0, 0});  // 200 counts further
  const float scale = rig_gains()[ECU_PARAMETER_SHAFT_SCALE];
  CHECK(channel.sensed.speed_rad_per_s == Approx(200 * scale / 0.002f));
}

TEST_CASE("PWM is 0 in every state except running, at any speed and load") {
  for (ecu_state state : {ECU_STATE_BOOT, ECU_STATE_IDLE, ECU_STATE_ARMED, ECU_STATE_FAULT}) {
    ecu_channel channel = in_state(state);
    for (std::int32_t n = 0; n < 20; ++n) {
      CHECK(tick(channel, {n * 700, 500, 2000}) == 0);
      CHECK(channel.state == state);
    }
  }
}

TEST_CASE("with gains that overflow PWM is 0") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  ecu_parameter(&channel, ECU_PARAMETER_FORCE_PREFILTER, 3e38f, false);
  ecu_parameter(&channel, ECU_PARAMETER_FORCE_K_TENSION, 3e38f, true);
  ecu_command(&channel, ECU_REQUEST_FORCE, 40000);
  CHECK(tick(channel, reading(0, 40)) == 0);
}
