#include "hal/can/gateway.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>

#include "tests/hal/can/pair.hpp"

using namespace can_test;
using erp::Heard;

namespace {

bool is_status(const erp::CanFrame& frame, int ecu, int channel) {
  return frame.id == frame_identifier(channel ? FRAME_STATUS_1 : FRAME_STATUS_0, std::uint8_t(ecu));
}

}  // namespace

TEST_CASE("a gateway that comes late is told the whole encoder count") {
  Pair pair;
  for (int tick = 0; tick < 5000; ++tick) pair.report();  // says more than 16 bits to nobody
  CHECK(std::abs(pair.robotics.frame.channels._buffer[0].encoder_counts) > 65536);
  const auto again = pair.ecus.again();
  CHECK(pair.hear({again.begin(), again.end()}) == 1);
  CHECK(difference(pair.gateway.frame(), pair.robotics.frame) == "");
}

TEST_CASE("a gateway that asks is told everything in the next tick") {
  Pair pair;
  for (int tick = 0; tick < 777; ++tick) pair.report();
  pair.send(pair.gateway.discover());
  CHECK(pair.hear(pair.report()) == 1);
  CHECK(difference(pair.gateway.frame(), pair.robotics.frame) == "");
  REQUIRE(pair.gateway.hellos().size() == 3);
  CHECK(pair.gateway.hellos()[0].named);
  CHECK(pair.gateway.hellos()[0].said.channels == 3);
  CHECK(pair.gateway.hellos()[2].said.channels == 1);
  CHECK(pair.gateway.understands(3));
  CHECK_FALSE(pair.gateway.understands(9));
}

TEST_CASE("what an ECU lacks of robot.xml is told, again after each boot") {
  Pair pair;
  const frame_hello poor{FRAME_VERSION, 0b01, 0, 0, 0};
  const frame_emergency boot{true, 0, 0, FRAME_RESET_POWER, FRAME_VERSION, 0};
  erp::CanFrame hello, booted;
  frame_pack_hello(&hello, 3, &poor);
  frame_pack_emergency(&booted, 3, &boot);
  for (int k = 0; k < 2; ++k) {
    for (int repeated = 0; repeated < 3; ++repeated) pair.gateway.hear(hello);
    REQUIRE(pair.gateway.hellos().size() == 1);
    CHECK(pair.gateway.hellos()[0].lacks_channels == 0b10);
    CHECK(pair.gateway.introduced(3));
    pair.gateway.clear_news();
    pair.gateway.hear(booted);
    CHECK_FALSE(pair.gateway.introduced(3));
  }
}

TEST_CASE("an ECU that has not said what it is is not listened to") {
  Pair pair;
  pair.report();
  for (int tick = 0; tick < 200; ++tick) CHECK(pair.hear(pair.report()) == 0);
  CHECK_FALSE(pair.gateway.understands(3));
}

TEST_CASE("an ECU that robot.xml does not name is told of, and changes nothing") {
  Pair pair(5);
  Pair larger(7);
  const auto frames = larger.report();
  CHECK(pair.hear(frames) == 1);
  const auto& hellos = pair.gateway.hellos();
  CHECK(std::count_if(hellos.begin(), hellos.end(), [](const auto& h) { return !h.named; }) == 1);
  CHECK_FALSE(pair.gateway.understands(6));
}

TEST_CASE("without lockstep a late gateway knows every encoder within 200 ms, and guesses none") {
  Pair pair;
  for (int tick = 0; tick < 777; ++tick) pair.report();
  const frame_hello known{FRAME_VERSION, 3, 0, 0, 0};
  for (std::uint8_t ecu = 3; ecu < 6; ++ecu) {  // of an earlier life of its: no HEALTH comes with it
    erp::CanFrame hello;
    frame_pack_hello(&hello, ecu, &known);
    pair.gateway.hear(hello);
  }
  for (int tick = 0; tick < 100; ++tick) {
    pair.hear(pair.report());
    for (int i = 0; i < 5; ++i) {  // a tick closed early may be the one before
      const auto truth = pair.robotics.frame.channels._buffer[i].encoder_counts;
      if (pair.sample(i).fresh) CHECK(std::abs(pair.sample(i).encoder_counts - truth) < 2000);
    }
  }
  CHECK(pair.hear(pair.report()) == 1);
  CHECK(difference(pair.gateway.frame(), pair.robotics.frame) == "");
}

TEST_CASE("a lost status leaves that channel stale, and the next tick whole again") {
  auto without_sensors = robot_of(5);
  without_sensors.joint_sensors.clear();
  for (const erp::Robot& robot : {robot_of(5), without_sensors}) {
    Pair pair(robot);
    pair.hear(pair.report());
    const auto encoder = pair.sample(1).encoder_counts;
    for (const auto& frame : pair.report())
      if (!is_status(frame, 3, 1)) CHECK(pair.gateway.hear(frame) == Heard::nothing);
    const auto truth_then = pair.robotics.frame;
    int ticks = 0;
    for (const auto& frame : pair.report()) {
      if (pair.gateway.hear(frame) != Heard::tick || ++ticks > 1) continue;
      CHECK_FALSE(pair.sample(1).fresh);
      CHECK(pair.sample(1).encoder_counts == encoder);
      for (int i : {0, 2, 3, 4}) CHECK(same(pair.sample(i), truth_then.channels._buffer[i]));
    }
    CHECK(ticks == 2);
    CHECK(difference(pair.gateway.frame(), pair.robotics.frame) == "");
    CHECK(pair.gateway.counters().lost == 1);
    CHECK(pair.gateway.counters().incomplete_ticks == 1);
  }
}

TEST_CASE("a tick closed by its deadline says who is missing") {
  Pair pair;
  pair.hear(pair.report());
  for (const auto& frame : pair.report())
    if (frame_ecu_of(&frame) != 4) pair.gateway.hear(frame);
  pair.gateway.close_tick();
  CHECK(pair.sample(0).fresh);
  CHECK_FALSE(pair.sample(2).fresh);
  CHECK_FALSE(pair.sample(3).fresh);
  CHECK(pair.sample(4).fresh);
  CHECK(pair.gateway.frame().sequence == 2);
}

TEST_CASE("a channel never heard is of unknown state") {
  Pair pair;
  pair.gateway.close_tick();
  CHECK(pair.sample(0).state == std::uint8_t(erp::EcuState::unknown));
  CHECK_FALSE(pair.sample(0).fresh);
}

TEST_CASE("corrupt, repeated and late frames change nothing and are counted") {
  Pair pair;
  pair.hear(pair.report());
  const auto old = pair.report();
  pair.hear(old);
  pair.hear(pair.report());
  const erp::EcuFrame before = pair.gateway.frame();
  for (auto frame : pair.report()) {
    frame.data[2] ^= 1;
    CHECK(pair.gateway.hear(frame) == Heard::nothing);
  }
  for (const auto& frame : old) CHECK(pair.gateway.hear(frame) == Heard::nothing);
  CHECK(difference(before, pair.gateway.frame()) == "");
  CHECK(pair.gateway.counters().corrupt == 9);  // 5 STATUS, 4 ANALOG
  CHECK(pair.gateway.counters().late == 9);
}

TEST_CASE("an ECU that boots in mid-run is taken up again, and its boot is told") {
  Pair pair;
  for (int tick = 0; tick < 2; ++tick) {
    pair.hear(pair.report());
    pair.send(pair.gateway.commands(
        command_for(pair.robot, pair.gateway.frame().sequence, ECU_REQUEST_OFF, 0)));
  }
  Robotics fresh(pair.robot, 2);
  erp::RobotEcus rebooted(pair.robot, fresh.lent);
  const auto boot = rebooted.boot(FRAME_RESET_BROWN_OUT);
  pair.hear({boot.begin(), boot.end()});
  REQUIRE(pair.gateway.emergencies().size() == 3);
  CHECK(pair.gateway.emergencies()[0].said.reset_cause == FRAME_RESET_BROWN_OUT);
  fresh.tick();
  const auto first = rebooted.report(fresh.frame);
  CHECK(pair.hear({first.begin(), first.end()}) == 1);
  CHECK(difference(pair.gateway.frame(), fresh.frame) == "");
  const auto sequence = pair.gateway.frame().sequence;
  for (const auto& frame : pair.gateway.commands(command_for(pair.robot, sequence, 0, 0)))
    CHECK(rebooted.hear(frame));
  CHECK(rebooted.answered());
}

TEST_CASE("after a boot an encoder is unknown until it is said whole") {
  Pair pair(2);
  pair.hear(pair.report());
  const auto boot = pair.ecus.boot(FRAME_RESET_WATCHDOG);
  pair.hear({boot.begin(), boot.end()});
  CHECK(pair.hear(pair.report()) == 0);
  pair.gateway.close_tick();
  CHECK_FALSE(pair.sample(0).fresh);
  const auto whole = pair.ecus.again();
  for (const auto& frame : whole) pair.gateway.hear(frame);
  pair.gateway.close_tick();
  CHECK(pair.sample(0).fresh);
}

TEST_CASE("an ECU that speaks another version of the layout is not listened to") {
  const frame_emergency emergency{true, 0, 0, FRAME_RESET_POWER, FRAME_VERSION + 1, 0};
  const frame_hello hello{FRAME_VERSION + 1, 1, 0, 0, 0};
  erp::CanFrame boot, answer;
  frame_pack_emergency(&boot, 3, &emergency);
  frame_pack_hello(&answer, 3, &hello);
  for (const auto& said : {boot, answer}) {
    Pair pair(1);
    CHECK(pair.hear(pair.report()) == 1);
    pair.gateway.hear(said);
    CHECK_FALSE(pair.gateway.understands(3));
    CHECK(pair.hear(pair.report()) == 0);
  }
}

TEST_CASE("commands and parameters for channels that are not there are counted, not sent") {
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

TEST_CASE("a parameter number beyond the bus's six bits spoils its set, it is never another one") {
  Pair pair;
  pair.arm();
  const float before = pair.robotics.channels[0].gains[0];
  erp::EcuParameter parameter;
  erp::append(parameter.values, erp::EcuParameterValue{3, 0, 64, true, 99});
  pair.send(pair.gateway.parameters(parameter));
  CHECK(pair.robotics.channels[0].gains[0] == before);
  CHECK(pair.robotics.channels[0].rejected_commits == 1);
}

TEST_CASE("two actuators on one channel, or sensors on one input, are refused") {
  auto robot = robot_of(2);
  robot.actuators[1].channel = 0;
  CHECK_THROWS_WITH(erp::Gateway(robot),
                    Catch::Contains("muscle_1") && Catch::Contains("ECU 3 channel 0"));
  Robotics robotics(robot, 1);
  CHECK_THROWS_WITH(erp::RobotEcus(robot, robotics.lent), Catch::Contains("ECU 3 channel 0"));
  robot = robot_of(2);
  robot.joint_sensors[1].input = 0;
  CHECK_THROWS_WITH(erp::Gateway(robot), Catch::Contains("joint_33") && Catch::Contains("input 0"));
  CHECK_THROWS_WITH(erp::RobotEcus(robot_of(3), robotics.lent),
                    Catch::Contains("has 3 actuators, got 2"));
}
