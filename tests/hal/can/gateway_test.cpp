#include "hal/can/gateway.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>

#include "tests/hal/can/pair.hpp"

using namespace can_test;
using erp::FrameResult;

namespace {

bool is_status(const erp::CanFrame& frame, int ecu, int channel) {
  return frame.id == frame_identifier(channel ? FRAME_STATUS_1 : FRAME_STATUS_0, std::uint8_t(ecu));
}

}  // namespace

TEST_CASE("a gateway that starts after 5000 ticks receives the full encoder count") {
  Pair pair;
  for (int tick = 0; tick < 5000; ++tick)
    pair.report();  // more than 16 bits of counts, not received
  CHECK(std::abs(pair.simulated.frame.channels._buffer[0].encoder_counts) > 65536);
  const auto repeated_frames = pair.ecus.repeat();
  CHECK(pair.receive({repeated_frames.begin(), repeated_frames.end()}) == 1);
  CHECK(difference(pair.gateway.frame(), pair.simulated.frame) == "");
}

TEST_CASE("after a DISCOVER a gateway receives all data in the next tick") {
  Pair pair;
  for (int tick = 0; tick < 777; ++tick) pair.report();
  pair.send(pair.gateway.discover());
  CHECK(pair.receive(pair.report()) == 1);
  CHECK(difference(pair.gateway.frame(), pair.simulated.frame) == "");
  REQUIRE(pair.gateway.hellos().size() == 3);
  CHECK(pair.gateway.hellos()[0].named);
  CHECK(pair.gateway.hellos()[0].content.channels == 3);
  CHECK(pair.gateway.hellos()[2].content.channels == 1);
  CHECK(pair.gateway.is_compatible(3));
  CHECK_FALSE(pair.gateway.is_compatible(9));
}

TEST_CASE("channels and inputs that an ECU lacks are reported after each boot") {
  Pair pair;
  const frame_hello incomplete_hello{FRAME_VERSION, 0b01, 0, 0, 0};
  const frame_emergency boot{true, 0, 0, FRAME_RESET_POWER, FRAME_VERSION, 0};
  erp::CanFrame hello, booted;
  frame_pack_hello(&hello, 3, &incomplete_hello);
  frame_pack_emergency(&booted, 3, &boot);
  for (int k = 0; k < 2; ++k) {
    for (int repeated = 0; repeated < 3; ++repeated) pair.gateway.receive(hello);
    REQUIRE(pair.gateway.hellos().size() == 1);
    CHECK(pair.gateway.hellos()[0].lacks_channels == 0b10);
    CHECK(pair.gateway.is_identified(3));
    pair.gateway.clear_events();
    pair.gateway.receive(booted);
    CHECK_FALSE(pair.gateway.is_identified(3));
  }
}

TEST_CASE("frames of an ECU that has not sent HELLO are ignored") {
  Pair pair;
  pair.report();
  for (int tick = 0; tick < 200; ++tick) CHECK(pair.receive(pair.report()) == 0);
  CHECK_FALSE(pair.gateway.is_compatible(3));
}

TEST_CASE("an ECU that robot.xml does not contain is reported and has no effect") {
  Pair pair(5);
  Pair larger(7);
  const auto frames = larger.report();
  CHECK(pair.receive(frames) == 1);
  const auto& hellos = pair.gateway.hellos();
  CHECK(std::count_if(hellos.begin(), hellos.end(), [](const auto& h) { return !h.named; }) == 1);
  CHECK_FALSE(pair.gateway.is_compatible(6));
}

TEST_CASE(
    "without lockstep a gateway that starts after the ECUs reports each encoder count within 200 "
    "ms, "
    "and only when it is known") {
  Pair pair;
  for (int tick = 0; tick < 777; ++tick) pair.report();
  const frame_hello known_hello{FRAME_VERSION, 3, 0, 0, 0};
  for (std::uint8_t ecu = 3; ecu < 6; ++ecu) {  // identified earlier: no HEALTH follows
    erp::CanFrame hello;
    frame_pack_hello(&hello, ecu, &known_hello);
    pair.gateway.receive(hello);
  }
  for (int tick = 0; tick < 100; ++tick) {
    pair.receive(pair.report());
    for (int i = 0; i < 5; ++i) {  // a tick closed early may be the previous one
      const auto truth = pair.simulated.frame.channels._buffer[i].encoder_counts;
      if (pair.sample(i).fresh) CHECK(std::abs(pair.sample(i).encoder_counts - truth) < 2000);
    }
  }
  CHECK(pair.receive(pair.report()) == 1);
  CHECK(difference(pair.gateway.frame(), pair.simulated.frame) == "");
}

TEST_CASE("after a lost status the channel is not fresh, and the next tick is complete") {
  auto without_sensors = robot_of(5);
  without_sensors.joint_sensors.clear();
  for (const erp::Robot& robot : {robot_of(5), without_sensors}) {
    Pair pair(robot);
    pair.receive(pair.report());
    const auto encoder = pair.sample(1).encoder_counts;
    for (const auto& frame : pair.report())
      if (!is_status(frame, 3, 1)) CHECK(pair.gateway.receive(frame) == FrameResult::nothing);
    const auto expected = pair.simulated.frame;
    int ticks = 0;
    for (const auto& frame : pair.report()) {
      if (pair.gateway.receive(frame) != FrameResult::tick || ++ticks > 1) continue;
      CHECK_FALSE(pair.sample(1).fresh);
      CHECK(pair.sample(1).encoder_counts == encoder);
      for (int i : {0, 2, 3, 4}) CHECK(same(pair.sample(i), expected.channels._buffer[i]));
    }
    CHECK(ticks == 2);
    CHECK(difference(pair.gateway.frame(), pair.simulated.frame) == "");
    CHECK(pair.gateway.counters().lost == 1);
    CHECK(pair.gateway.counters().incomplete_ticks == 1);
  }
}

TEST_CASE("a tick closed by its deadline marks the missing channels") {
  Pair pair;
  pair.receive(pair.report());
  for (const auto& frame : pair.report())
    if (frame_ecu_of(&frame) != 4) pair.gateway.receive(frame);
  pair.gateway.close_tick();
  CHECK(pair.sample(0).fresh);
  CHECK_FALSE(pair.sample(2).fresh);
  CHECK_FALSE(pair.sample(3).fresh);
  CHECK(pair.sample(4).fresh);
  CHECK(pair.gateway.frame().sequence == 2);
}

TEST_CASE("a channel that was never received has state unknown") {
  Pair pair;
  pair.gateway.close_tick();
  CHECK(pair.sample(0).state == std::uint8_t(erp::EcuState::unknown));
  CHECK_FALSE(pair.sample(0).fresh);
}

TEST_CASE("corrupt, repeated and outdated frames are counted and have no effect") {
  Pair pair;
  pair.receive(pair.report());
  const auto old_frames = pair.report();
  pair.receive(old_frames);
  pair.receive(pair.report());
  const erp::EcuFrame before = pair.gateway.frame();
  for (auto frame : pair.report()) {
    frame.data[2] ^= 1;
    CHECK(pair.gateway.receive(frame) == FrameResult::nothing);
  }
  for (const auto& frame : old_frames) CHECK(pair.gateway.receive(frame) == FrameResult::nothing);
  CHECK(difference(before, pair.gateway.frame()) == "");
  CHECK(pair.gateway.counters().corrupt == 9);  // 5 STATUS, 4 ANALOG
  CHECK(pair.gateway.counters().late == 9);
}

TEST_CASE("an ECU that boots during a run is used again, and its boot is reported") {
  Pair pair;
  for (int tick = 0; tick < 2; ++tick) {
    pair.receive(pair.report());
    pair.send(pair.gateway.commands(
        command_for(pair.robot, pair.gateway.frame().sequence, ECU_REQUEST_OFF, 0)));
  }
  SimulatedChannels rebooted_channels(pair.robot, 2);
  erp::RobotEcus rebooted(pair.robot, rebooted_channels.channel_pointers);
  const auto boot = rebooted.boot(FRAME_RESET_BROWN_OUT);
  pair.receive({boot.begin(), boot.end()});
  REQUIRE(pair.gateway.emergencies().size() == 3);
  CHECK(pair.gateway.emergencies()[0].content.reset_cause == FRAME_RESET_BROWN_OUT);
  rebooted_channels.tick();
  const auto first = rebooted.report(rebooted_channels.frame);
  CHECK(pair.receive({first.begin(), first.end()}) == 1);
  CHECK(difference(pair.gateway.frame(), rebooted_channels.frame) == "");
  const auto sequence = pair.gateway.frame().sequence;
  for (const auto& frame : pair.gateway.commands(command_for(pair.robot, sequence, 0, 0)))
    CHECK(rebooted.receive(frame));
  CHECK(rebooted.answered());
}

TEST_CASE("after a boot an encoder count is unknown until its HEALTH frame arrives") {
  Pair pair(2);
  pair.receive(pair.report());
  const auto boot = pair.ecus.boot(FRAME_RESET_WATCHDOG);
  pair.receive({boot.begin(), boot.end()});
  CHECK(pair.receive(pair.report()) == 0);
  pair.gateway.close_tick();
  CHECK_FALSE(pair.sample(0).fresh);
  const auto all_frames = pair.ecus.repeat();
  for (const auto& frame : all_frames) pair.gateway.receive(frame);
  pair.gateway.close_tick();
  CHECK(pair.sample(0).fresh);
}

TEST_CASE("frames of an ECU with another layout version are ignored") {
  const frame_emergency emergency{true, 0, 0, FRAME_RESET_POWER, FRAME_VERSION + 1, 0};
  const frame_hello hello{FRAME_VERSION + 1, 1, 0, 0, 0};
  erp::CanFrame boot, answer;
  frame_pack_emergency(&boot, 3, &emergency);
  frame_pack_hello(&answer, 3, &hello);
  for (const auto& content : {boot, answer}) {
    Pair pair(1);
    CHECK(pair.receive(pair.report()) == 1);
    pair.gateway.receive(content);
    CHECK_FALSE(pair.gateway.is_compatible(3));
    CHECK(pair.receive(pair.report()) == 0);
  }
}

TEST_CASE("commands and parameters for unknown channels are counted and not sent") {
  Pair pair;
  erp::EcuCommand command;
  for (auto [ecu, channel] : {std::pair{99, 0}, {200, 0}, {3, 2}, {5, 1}})
    erp::append(command.channels,
                erp::EcuChannelCommand{std::uint8_t(ecu), std::uint8_t(channel), 2, 0});
  CHECK(pair.gateway.commands(command).empty());
  erp::EcuParameter parameter;
  erp::append(parameter.values, erp::EcuParameterValue{99, 0, 0, false, 1});
  CHECK(pair.gateway.parameters(parameter).empty());
  CHECK(pair.gateway.counters().unknown_channels == 5);
}

TEST_CASE(
    "a parameter number beyond six bits invalidates its set and is never sent as another number") {
  Pair pair;
  pair.arm();
  const float before = pair.simulated.channels[0].gains[0];
  erp::EcuParameter parameter;
  erp::append(parameter.values, erp::EcuParameterValue{3, 0, 64, true, 99});
  pair.send(pair.gateway.parameters(parameter));
  CHECK(pair.simulated.channels[0].gains[0] == before);
  CHECK(pair.simulated.channels[0].rejected_commits == 1);
}

TEST_CASE("a zero of an encoder reaches its ECU in the middle of a gain set") {
  Pair pair;
  pair.arm();
  pair.receive(pair.report());
  CHECK_FALSE(pair.sample(0).zero_known);
  const auto before = pair.sample(0).encoder_counts;
  const std::uint32_t commits = pair.simulated.channels[0].accepted_commits;
  constexpr std::int32_t added = 700'000;  // more than the 16 bits of STATUS
  erp::EcuParameter message;
  erp::append(message.values, erp::EcuParameterValue{3, 0, ECU_PARAMETER_LENGTH_KP, false, 20});
  erp::append(message.values, erp::EcuParameterValue{3, 0, ECU_ZERO, false, added});
  erp::append(message.values, erp::EcuParameterValue{3, 0, ECU_PARAMETER_CURRENT_KP, true, 1});
  pair.send(pair.gateway.parameters(message));
  CHECK(pair.simulated.channels[0].accepted_commits == commits + 1);
  pair.receive(pair.report());
  CHECK(pair.sample(0).zero_known);
  CHECK(std::abs(pair.sample(0).encoder_counts - before - added) < 1000);  // the rig's own motion
  CHECK(difference(pair.gateway.frame(), pair.simulated.frame) == "");
  CHECK_FALSE(pair.sample(1).zero_known);
}

TEST_CASE("a reset whose boot frame was lost makes the zero unknown with the first status") {
  Pair pair;
  pair.arm();
  for (auto& channel : pair.simulated.channels) ecu_set_zero(&channel, true, 1000);
  for (int tick = 0; tick < 200; ++tick) pair.receive(pair.report());  // every HEALTH page
  CHECK(pair.sample(0).zero_known);
  ecu_init(&pair.simulated.channels[0]);
  pair.receive(pair.report());
  CHECK_FALSE(pair.sample(0).zero_known);
  CHECK(pair.sample(1).zero_known);
}

TEST_CASE("two actuators on one channel, or two sensors on one input, are refused") {
  auto robot = robot_of(2);
  robot.actuators[1].channel = 0;
  CHECK_THROWS_WITH(erp::Gateway(robot),
                    Catch::Contains("muscle_1") && Catch::Contains("ECU 3 channel 0"));
  SimulatedChannels simulated(robot, 1);
  CHECK_THROWS_WITH(erp::RobotEcus(robot, simulated.channel_pointers),
                    Catch::Contains("ECU 3 channel 0"));
  robot = robot_of(2);
  robot.joint_sensors[1].input = 0;
  CHECK_THROWS_WITH(erp::Gateway(robot), Catch::Contains("joint_33") && Catch::Contains("input 0"));
  CHECK_THROWS_WITH(erp::RobotEcus(robot_of(3), simulated.channel_pointers),
                    Catch::Contains("has 3 actuators, got 2"));
}
