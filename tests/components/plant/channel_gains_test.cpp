#include "components/plant/channel_gains.hpp"

#include <catch2/catch.hpp>

#include "tests/components/plant/bench.hpp"

using bench::Bench;
using bench::ms;
using plant::ChannelGains;
using Result = plant::ChannelGains::Result;

namespace {

sim::EcuParameters designed() {
  const erp::Robot robot = bench::one_muscle();
  return sim::design_parameters(robot, robot.actuators[0], {});
}

/// The gains of an ECU that has been idle for a second.
struct Idle {
  ChannelGains gains{0, 0, designed()};
  erp::EcuParameter message;
  Idle() {
    gains.observe(ECU_STATE_BOOT, 0, 0, ms);
    gains.observe(ECU_STATE_IDLE, 1, 0, 1000 * ms);
  }
  std::uint32_t send(std::int64_t now_ns) {
    message.values._length = 0;
    gains.append_next(message, now_ns);
    return message.values._length;
  }
};

std::vector<plant::Notice> set_gain(Bench& bench, const char* controller, int priority,
                                    const char* parameter, double value) {
  erp::GainCommand command;
  erp::assign(command.controller, controller);
  command.priority = priority;
  erp::GainValue gain{};
  erp::assign(gain.name, "flexor");
  erp::assign(gain.parameter, parameter);
  gain.value = value;
  erp::append(command.gains, gain);
  bench.plant.take_notices();
  bench.plant.receive(command);
  return bench.plant.take_notices();
}

}  // namespace

TEST_CASE("a gain of a law may have any value; a limit may be lowered to above 0, but not raised") {
  ChannelGains gains(0, 0, designed());
  CHECK(gains.refusal("force_gain_V_per_N", -3) == "");
  CHECK(gains.refusal("tension_trip_N", 100) == "");
  CHECK(gains.refusal("tension_trip_N", 500).find("at most robot.xml's 180") != std::string::npos);
  CHECK(gains.refusal("current_limit_A", 0).find("above 0") != std::string::npos);
  CHECK(gains.refusal("current_limit_A", 4.1).find("at most robot.xml's 4") != std::string::npos);
}

TEST_CASE("a check that robot.xml leaves out may be added") {
  ChannelGains gains(0, 0, designed());
  CHECK(gains.refusal("temperature_C_per_count", 0.1) == "");
  CHECK(gains.refusal("temperature_trip_C", 90) == "");
  CHECK(gains.refusal("overload_A2_s", 20) == "");
}

TEST_CASE(
    "the overload check of robot.xml can be neither switched off by a tiny limit nor weakened") {
  auto parameters = designed();
  parameters[ECU_PARAMETER_OVERLOAD_LIMIT] = 1;
  const ChannelGains gains(0, 0, parameters);
  CHECK_FALSE(gains.refusal("overload_A2_s", 1e-60).empty());
  CHECK_FALSE(gains.refusal("current_continuous_A", 1000).empty());
  CHECK(gains.refusal("overload_A2_s", 0.5).empty());
}

TEST_CASE("one refused value refuses all values of its actuator") {
  Bench bench;
  erp::GainCommand command;
  for (const auto& [parameter, value] : {std::pair{"length_gain_V_per_rad", 3.0}, {"charm", 1.0}}) {
    erp::GainValue gain{};
    erp::assign(gain.name, "flexor");
    erp::assign(gain.parameter, parameter);
    gain.value = value;
    erp::append(command.gains, gain);
  }
  bench.ecu_reports(ECU_STATE_BOOT);
  bench.now_ns += 1000 * ms;
  bench.ecu_reports(ECU_STATE_IDLE);
  bench.plant.receive(command);
  CHECK(bench.plant.gains(bench.now_ns, false).values._length == 0);
}

TEST_CASE("scales, unknown names and values that are not numbers are refused") {
  ChannelGains gains(0, 0, designed());
  CHECK(gains.refusal("shaft_rad_per_count", 1).find("robot.xml") != std::string::npos);
  CHECK(gains.refusal("tension_N_per_count", 1).find("robot.xml") != std::string::npos);
  CHECK(gains.refusal("charm", 1) == "there is no gain charm");
  CHECK(gains.refusal("length_gain_V_per_rad", NAN).find("must be a number") != std::string::npos);
}

TEST_CASE("a set replaces the accepted gains only when the ECU has accepted it") {
  Idle idle;
  idle.gains.propose("length_gain_V_per_rad", 3);
  REQUIRE(idle.send(1000 * ms) == 1);
  CHECK(idle.message.values._buffer[0].commit);
  CHECK(idle.gains.accepted(ECU_PARAMETER_LENGTH_KP) == designed()[ECU_PARAMETER_LENGTH_KP]);
  CHECK(idle.gains.observe(ECU_STATE_IDLE, 1, 0, 1100 * ms) == Result::none);
  CHECK(idle.gains.observe(ECU_STATE_IDLE, 2, 0, 1200 * ms) == Result::accepted);
  CHECK(idle.gains.accepted(ECU_PARAMETER_LENGTH_KP) == 3);
  CHECK(idle.gains.text() == "length_gain_V_per_rad = 3");
}

TEST_CASE("a set that the ECU refuses, or does not answer for 1 s, is forgotten") {
  for (const auto expected : {Result::refused, Result::unanswered}) {
    Idle idle;
    idle.gains.propose("length_gain_V_per_rad", -1);
    REQUIRE(idle.send(1000 * ms) == 1);
    const std::uint8_t refused = expected == Result::refused;
    const std::int64_t at_ns = refused ? 1200 * ms : 2001 * ms;
    CHECK(idle.gains.observe(ECU_STATE_IDLE, 1, refused, at_ns) == expected);
    CHECK(idle.gains.accepted(ECU_PARAMETER_LENGTH_KP) == designed()[ECU_PARAMETER_LENGTH_KP]);
    CHECK(idle.send(2002 * ms) == 0);
  }
}

TEST_CASE("while a set is under way the next one waits, and its values are sent together") {
  Idle idle;
  idle.gains.propose("length_gain_V_per_rad", 3);
  REQUIRE(idle.send(1000 * ms) == 1);
  idle.gains.propose("length_gain_V_per_rad", 4);
  idle.gains.propose("current_gain_V_per_A", 1);
  idle.gains.propose("length_gain_V_per_rad", 5);
  CHECK(idle.send(1100 * ms) == 0);
  idle.gains.observe(ECU_STATE_RUNNING, 2, 0, 1200 * ms);
  REQUIRE(idle.send(1202 * ms) == 2);
  CHECK(idle.message.values._buffer[1].value == 5);
}

TEST_CASE("after a reset the ECU gets the gains that it accepted last, never a refused set") {
  Idle idle;
  idle.gains.propose("length_gain_V_per_rad", -1);
  idle.send(1000 * ms);
  idle.gains.observe(ECU_STATE_IDLE, 1, 1, 1200 * ms);
  idle.gains.observe(ECU_STATE_BOOT, 0, 0, 1300 * ms);
  idle.message.values._length = 0;
  idle.gains.append_all(idle.message);
  REQUIRE(idle.message.values._length == ECU_PARAMETER_COUNT);
  const auto& length_gain = idle.message.values._buffer[ECU_PARAMETER_LENGTH_KP];
  CHECK(length_gain.value == designed()[ECU_PARAMETER_LENGTH_KP]);
  CHECK(idle.message.values._buffer[ECU_PARAMETER_COUNT - 1].commit);
}

TEST_CASE("gains from a controller that the actuator's owner outranks are refused and reported") {
  Bench bench;
  bench.run("a");
  const auto notices = set_gain(bench, "b", -1, "length_gain_V_per_rad", 3);
  REQUIRE(notices.size() == 1);
  CHECK(notices[0].code == "gain_refused");
  CHECK(notices[0].text.find("a is the owner") != std::string::npos);
  CHECK(set_gain(bench, "a", 0, "length_gain_V_per_rad", 3).empty());
  CHECK(set_gain(bench, "b", 1, "length_gain_V_per_rad", 3).empty());
}

TEST_CASE("an ECU that stays in state boot for 2 s is reported and lost until it leaves it") {
  Bench bench;
  const auto reports = [&](const char* code) {
    int count = 0;
    for (const auto& notice : bench.plant.take_notices()) count += notice.code == code;
    return count;
  };
  for (int k = 0; k < 1000; ++k)
    bench.ecu_reports(ECU_STATE_BOOT), bench.request(), bench.now_ns += 2 * ms;
  CHECK(reports("gains_missing") == 0);
  int missing = 0, lost = 0;
  for (int k = 0; k < 50; ++k) {
    bench.ecu_reports(ECU_STATE_BOOT), bench.request(), bench.now_ns += 2 * ms;
    for (const auto& notice : bench.plant.take_notices())
      missing += notice.code == "gains_missing", lost += notice.code == "ecu_lost";
  }
  CHECK(missing == 1);
  CHECK(lost == 1);
  bench.command("a", 0, erp::Mode::force, 10);
  bench.ecu_reports(ECU_STATE_IDLE);
  CHECK(bench.request().request == ECU_REQUEST_ARM);
}
