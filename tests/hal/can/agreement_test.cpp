// Properties of gateway and ECUs that hold for any bus between them.
#include <catch2/catch.hpp>
#include <set>

#include "tests/allocations.hpp"
#include "tests/hal/can/pair.hpp"

using namespace can_test;
using erp::FrameResult;

TEST_CASE("a run over the bus equals the run without it, bit for bit") {
  for (int actuators : {1, 2, 5, 64}) {
    Pair pair(actuators);
    SimulatedChannels direct(pair.robot, 1);
    std::mt19937 random(7);
    std::set<int> states;
    for (int tick = 0; tick < 2000; ++tick) {
      INFO(actuators << " actuators, tick " << tick);
      direct.tick();
      REQUIRE(pair.receive(pair.report()) == 1);
      REQUIRE(difference(pair.gateway.frame(), direct.frame) == "");
      for (const auto& sample : erp::samples(direct.frame.channels)) states.insert(sample.state);
      if (tick % 500 == 0) {
        const auto gains = gains_for(pair.robot);
        direct.apply(gains);
        pair.send(pair.gateway.parameters(gains));
      }
      if (tick % 400 > 360) continue;  // no commands: running channels trip
      const auto command = any_command(pair.robot, pair.gateway.frame().sequence, random);
      direct.apply(command);
      pair.send(pair.gateway.commands(command));
    }
    CHECK(states == std::set{0, 1, 2, 3, 4});
    CHECK(pair.gateway.counters().lost == 0);
    CHECK(pair.gateway.counters().repeated == 0);
    CHECK(pair.gateway.counters().incomplete_ticks == 0);
  }
}

TEST_CASE("the ECUs detect when the whole robot has answered their tick") {
  Pair pair;
  for (int tick = 0; tick < 30; ++tick) {
    pair.receive(pair.report());
    CHECK_FALSE(pair.ecus.answered());
    const auto sequence = pair.gateway.frame().sequence;
    if (tick > 0) {  // an answer to the previous tick does not count
      pair.send(pair.gateway.commands(command_for(pair.robot, sequence - 1, ECU_REQUEST_OFF, 0)));
      CHECK_FALSE(pair.ecus.answered());
    }
    pair.send(pair.gateway.commands(command_for(pair.robot, sequence, ECU_REQUEST_OFF, 0)));
    CHECK(pair.ecus.answered());
  }
  CHECK(pair.ecus.link(3)->repeated == 0);
}

TEST_CASE("a second command that answers the same tick is accepted by the ECUs") {
  Pair pair;
  pair.receive(pair.report());
  pair.arm();
  for (int mV = 1; mV < 40; ++mV) {
    pair.send(pair.gateway.commands(command_for(pair.robot, 1, ECU_REQUEST_VOLTAGE, mV)));
    CHECK(pair.simulated.channels[0].setpoint == mV);
  }
}

TEST_CASE("a lost command is repeated when the ECUs repeat their tick") {
  Pair pair;
  pair.receive(pair.report());
  const auto lost = pair.gateway.commands(command_for(pair.robot, 1, ECU_REQUEST_OFF, 0));
  CHECK(lost.size() == 3);
  bool sent = false;
  for (const auto& frame : std::vector(pair.ecus.repeat().begin(), pair.ecus.repeat().end()))
    if (pair.gateway.receive(frame) == FrameResult::tick_repeated)
      pair.send(pair.gateway.repeat()), sent = true;
  CHECK(sent);
  CHECK(pair.ecus.answered());
  CHECK(pair.gateway.frame().sequence == 1);
}

TEST_CASE(
    "after lost, repeated and corrupt frames no channel has tripped and gateway and ECUs agree") {
  Pair pair;
  std::mt19937 random(3);
  pair.receive(pair.report());
  pair.arm();
  const auto disturbed = [&](std::span<const erp::CanFrame> frames, auto deliver) {
    for (auto frame : std::vector(frames.begin(), frames.end())) {
      const auto chance = random() % 100;
      if (chance < 10) continue;
      if (chance < 12) frame.data[random() % 8] ^= 4;
      for (int copies = chance < 20 ? 2 : 1; copies > 0; --copies) deliver(frame);
    }
  };
  for (int tick = 0; tick < 5000; ++tick) {
    disturbed(pair.report(), [&](const auto& frame) { pair.gateway.receive(frame); });
    const auto sequence = pair.gateway.frame().sequence;
    disturbed(pair.gateway.commands(command_for(pair.robot, sequence, ECU_REQUEST_FORCE, tick)),
              [&](const auto& frame) { pair.ecus.receive(frame); });
    for (const auto& channel : pair.simulated.channels)
      REQUIRE((channel.state == ECU_STATE_RUNNING || channel.state == ECU_STATE_ARMED));
  }
  CHECK(pair.gateway.counters().lost > 1000);
  CHECK(pair.gateway.counters().corrupt > 100);
  for (int tick = 0; tick < 3; ++tick) {
    pair.receive(pair.report());
    pair.send(pair.gateway.commands(
        command_for(pair.robot, pair.gateway.frame().sequence, ECU_REQUEST_FORCE, 5)));
  }
  pair.receive(pair.report());
  CHECK(difference(pair.gateway.frame(), pair.simulated.frame) == "");
}

TEST_CASE("gateway and ECUs do not use the heap after construction") {
  Pair pair(64);
  const auto gains = gains_for(pair.robot);
  std::mt19937 random(4);
  std::vector<erp::EcuCommand> commands;
  for (int tick = 0; tick < 100; ++tick)
    commands.push_back(any_command(pair.robot, std::uint64_t(tick + 1), random));
  const std::size_t before = tests::allocations();
  for (const auto& command : commands) {
    pair.simulated.tick();
    for (const auto& frame : pair.ecus.report(pair.simulated.frame)) pair.gateway.receive(frame);
    for (const auto& frame : pair.gateway.parameters(gains)) pair.ecus.receive(frame);
    for (const auto& frame : pair.gateway.commands(command)) pair.ecus.receive(frame);
    pair.gateway.clear_events();
  }
  CHECK(tests::allocations() == before);
}

TEST_CASE("random frames never stop a gateway") {
  Pair pair;
  std::mt19937 random(5);
  pair.receive(pair.report());
  for (int n = 0; n < 300000; ++n) {
    erp::CanFrame frame{std::uint16_t(random()), 8, {}};
    for (auto& byte : frame.data) byte = std::uint8_t(random());
    if (n % 2) {  // valid check value, random content
      frame.id = std::uint16_t(frame.id & 0x7FF);
      std::uint8_t checked_bytes[9] = {std::uint8_t(frame.id & 0xFF), std::uint8_t(frame.id >> 8)};
      std::copy_n(frame.data, 7, checked_bytes + 2);
      frame.data[7] = frame_crc8(checked_bytes, 9);
    }
    pair.gateway.receive(frame);
    pair.ecus.receive(frame);
  }
  SUCCEED();
}
