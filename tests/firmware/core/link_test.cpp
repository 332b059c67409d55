#include "firmware/core/link.h"

#include <array>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "tests/firmware/core/channel.hpp"

using namespace firmware;

namespace {

/// One ECU with two channels and the host's commands to it.
struct Ecu {
  std::array<ecu_channel, 2> channel{in_state(ECU_STATE_RUNNING), in_state(ECU_STATE_RUNNING)};
  ecu_link link;

  Ecu() { ecu_link_init(&link, 12, &channel[0], &channel[1], 0b0101); }

  bool command(std::uint8_t count, std::int32_t setpoint_mV, std::uint8_t answers = 0) {
    return receive(packed(count, setpoint_mV, answers));
  }
  static bus_frame packed(std::uint8_t count, std::int32_t setpoint_mV, std::uint8_t answers = 0) {
    const frame_command content{
        {{ECU_REQUEST_VOLTAGE, setpoint_mV}, {FRAME_REQUEST_NONE, 0}}, answers, count};
    bus_frame frame;
    frame_pack_command(&frame, 12, &content);
    return frame;
  }
  bool parameter(std::uint8_t position, std::uint8_t index, float value, bool commit) {
    const frame_parameter content{0, index, commit, position, value};
    bus_frame frame;
    frame_pack_parameter(&frame, 12, &content);
    return receive(frame);
  }
  bool receive(const bus_frame& frame) { return ecu_link_receive(&link, &frame); }

  std::vector<bus_frame> frames(bool all_pages = false) {
    ecu_link_tick(&link);
    const ecu_report report{{ecu_reading_of(&channel[0]), ecu_reading_of(&channel[1])},
                            {11, 22, 33, 44}};
    std::vector<bus_frame> frames(ECU_LINK_FRAMES_MAX);
    frames.resize(ecu_link_pack(&link, &report, all_pages, frames.data()));
    return frames;
  }
};

int count(const std::vector<bus_frame>& frames, frame_function function) {
  return int(std::count_if(frames.begin(), frames.end(), [&](const bus_frame& frame) {
    return frame_function_of(&frame) == function;
  }));
}

}  // namespace

TEST_CASE("a command acts only on the channels that it addresses") {
  Ecu ecu;
  CHECK(ecu.command(1, 2000));
  CHECK(ecu.channel[0].setpoint == 2000);
  CHECK(ecu.channel[1].setpoint == 1000);
}

TEST_CASE("frames for other ECUs and frames from ECUs are ignored") {
  Ecu ecu;
  bus_frame frame = Ecu::packed(1, 2000);
  const frame_command content{{{ECU_REQUEST_OFF, 0}, {ECU_REQUEST_OFF, 0}}, 1, 0};
  frame_pack_command(&frame, 13, &content);
  CHECK_FALSE(ecu.receive(frame));
  for (const bus_frame& own_frame : ecu.frames(true)) CHECK_FALSE(ecu.receive(own_frame));
  CHECK(ecu.link.corrupt == 0);
  CHECK(ecu.channel[0].state == ECU_STATE_RUNNING);
}

TEST_CASE("a repeated command does not reset the command timeout") {
  Ecu ecu;
  for (int i = 0; i < 26; ++i) ecu.command(1, 1200), tick(ecu.channel[0]);
  CHECK(ecu.channel[0].fault == ECU_FAULT_COMMAND_TIMEOUT);
  CHECK(ecu.link.repeated == 25);
}

TEST_CASE("an outdated command is dropped and counted; lost commands are counted") {
  Ecu ecu;
  CHECK(ecu.command(5, 2000));
  CHECK_FALSE(ecu.command(4, 3000));
  CHECK(ecu.channel[0].setpoint == 2000);
  CHECK(ecu.link.late == 1);
  CHECK(ecu.command(0, 4000));  // 6 and 7 are lost
  CHECK(ecu.link.lost == 2);
  CHECK(ecu.command(1, 5000));
  CHECK(ecu.channel[0].setpoint == 5000);
  CHECK(ecu.link.lost == 2);
}

TEST_CASE("the older of two reordered commands is dropped, independent of `answers`") {
  Ecu ecu;
  CHECK(ecu.command(2, 2000, 0));
  CHECK_FALSE(ecu.command(1, 3000, 5));  // computed from a STATUS three periods older
  CHECK(ecu.channel[0].setpoint == 2000);
}

TEST_CASE("a tick is answered only by the command that carries its counter") {
  Ecu ecu;
  ecu.frames(true);
  CHECK_FALSE(ecu.link.answered);
  ecu.command(1, 1000, 0);
  CHECK_FALSE(ecu.link.answered);
  ecu.command(2, 1000, 1);
  CHECK(ecu.link.answered);
  ecu.frames();
  CHECK_FALSE(ecu.link.answered);
}

TEST_CASE("five consecutive corrupt frames trip both channels; four and a valid one do not") {
  Ecu ecu;
  bus_frame bad = Ecu::packed(1, 2000);
  bad.data[3] ^= 0x10;
  for (std::uint8_t round = 0; round < 3; ++round) {
    for (int i = 0; i < 4; ++i) CHECK_FALSE(ecu.receive(bad));
    CHECK(ecu.command(round, 2000));
  }
  CHECK(ecu.channel[0].state == ECU_STATE_RUNNING);
  for (int i = 0; i < 5; ++i) ecu.receive(bad);
  CHECK(ecu.channel[0].fault == ECU_FAULT_CORRUPT);
  CHECK(ecu.channel[1].fault == ECU_FAULT_CORRUPT);
  CHECK(ecu.link.corrupt == 17);
}

TEST_CASE("a gain set with one lost frame at any position is refused as a whole") {
  for (std::uint8_t lost = 0; lost < 3; ++lost) {
    INFO("lost frame " << int(lost));
    Ecu ecu;
    const Gains before = rig_gains();
    const std::uint8_t indices[] = {ECU_PARAMETER_LENGTH_KP, ECU_PARAMETER_CURRENT_KP,
                                    ECU_PARAMETER_CURRENT_KI};
    REQUIRE(ecu.parameter(0, ECU_PARAMETER_CURRENT_KD, 0, true));
    for (std::uint8_t p = 0; p < 3; ++p)
      if (p != lost) ecu.parameter(p, indices[p], 1.0f, p == 2);
    if (lost == 2) ecu.parameter(0, ECU_PARAMETER_CURRENT_KD, 0, true);
    CHECK(std::equal(before.begin(), before.end(), ecu.channel[0].gains));
    for (std::uint8_t p = 0; p < 3; ++p) CHECK(ecu.parameter(p, indices[p], 2.0f, p == 2));
    CHECK(ecu.channel[0].gains[ECU_PARAMETER_LENGTH_KP] == 2.0f);
  }
}

TEST_CASE("a gain set is accepted when every frame arrives twice") {
  Ecu ecu;
  const Gains gains = rig_gains();
  for (std::uint8_t p = 0; p < ECU_PARAMETER_COUNT; ++p)
    for (int twice = 0; twice < 2; ++twice)
      ecu.parameter(p, p, gains[p] * 1.01f, p + 1 == ECU_PARAMETER_COUNT);
  CHECK(ecu.channel[0].gains[ECU_PARAMETER_LENGTH_KP] == 40 * 1.01f);
  CHECK(ecu.channel[0].rejected_commits == 0);
}

TEST_CASE("a period is sent as the analog inputs followed by one status per channel") {
  Ecu ecu;
  const auto frames = ecu.frames();
  REQUIRE(frames.size() == 4);
  frame_analog analog;
  REQUIRE(frame_unpack_analog(&frames[0], &analog));
  CHECK(analog.present == 1);
  CHECK(analog.counts[0] == 11);
  REQUIRE(frame_unpack_analog(&frames[1], &analog));
  CHECK(analog.page == 1);
  CHECK(analog.counts[0] == 33);
  CHECK(frame_function_of(&frames[2]) == FRAME_STATUS_0);
  CHECK(frame_function_of(&frames[3]) == FRAME_STATUS_1);
}

TEST_CASE("the full health of every channel is sent once in 200 ms") {
  Ecu ecu;
  int pages[2][2] = {};
  for (int i = 0; i < 100; ++i)
    for (const bus_frame& frame : ecu.frames()) {
      frame_health health;
      if (frame_unpack_health(&frame, &health))
        ++pages[frame_function_of(&frame) == FRAME_HEALTH_1][health.page];
    }
  for (auto& channel : pages) CHECK((channel[0] == 1 && channel[1] == 1));
  CHECK(ecu.frames(true).size() == 9);
}

TEST_CASE("a fault is sent once as an emergency frame; a new fault is sent again") {
  Ecu ecu;
  ecu_trip(&ecu.channel[1], ECU_FAULT_OVER_TENSION);
  const auto frames = ecu.frames();
  frame_emergency content;
  REQUIRE(frame_unpack_emergency(&frames[0], &content));
  CHECK(content.channel == 1);
  CHECK(content.fault == ECU_FAULT_OVER_TENSION);
  CHECK(count(ecu.frames(), FRAME_EMERGENCY) == 0);
  ecu_command(&ecu.channel[1], ECU_REQUEST_CLEAR, ecu.channel[1].fault);
  CHECK(count(ecu.frames(), FRAME_EMERGENCY) == 0);
  ecu_trip(&ecu.channel[1], ECU_FAULT_CORRUPT);
  CHECK(count(ecu.frames(), FRAME_EMERGENCY) == 1);
}

TEST_CASE("a boot is sent with its cause and the version of the layout") {
  Ecu ecu;
  bus_frame frame;
  ecu_link_pack_boot(&ecu.link, FRAME_RESET_WATCHDOG, &frame);
  frame_emergency content;
  REQUIRE(frame_unpack_emergency(&frame, &content));
  CHECK(content.boot);
  CHECK(content.reset_cause == FRAME_RESET_WATCHDOG);
  CHECK(content.version == FRAME_VERSION);
}

TEST_CASE("frames of random bytes are rejected") {
  Ecu ecu;
  std::mt19937 random_bits(2);
  for (int n = 0; n < 200000; ++n) {
    bus_frame frame{std::uint16_t(random_bits() & 0x7FF), std::uint8_t(random_bits() % 10), {}};
    for (auto& byte : frame.data) byte = std::uint8_t(random_bits());
    if (!frame_is_intact(&frame)) CHECK_FALSE(ecu.receive(frame));
  }
}

TEST_CASE("an ECU with one channel accepts a frame for two") {
  ecu_channel channel = in_state(ECU_STATE_RUNNING);
  ecu_link link;
  ecu_link_init(&link, 12, nullptr, &channel, 0);
  const frame_command content{{{ECU_REQUEST_VOLTAGE, 1}, {ECU_REQUEST_VOLTAGE, 2}}, 0, 0};
  bus_frame frame;
  frame_pack_command(&frame, 12, &content);
  CHECK(ecu_link_receive(&link, &frame));
  CHECK(channel.setpoint == 2);
}

TEST_CASE("after a DISCOVER an ECU sends HELLO and every HEALTH page once") {
  Ecu ecu;
  ecu.link.serial = 0x123456;
  for (const std::uint8_t to : {std::uint8_t{12}, std::uint8_t{FRAME_EVERYONE}}) {
    bus_frame discover;
    frame_pack_discover(&discover, to);
    CHECK(ecu.receive(discover));
    const auto content = ecu.frames();
    REQUIRE(count(content, FRAME_HELLO) == 1);
    CHECK(count(content, FRAME_HEALTH_0) + count(content, FRAME_HEALTH_1) == 4);
    frame_hello hello;
    REQUIRE(frame_unpack_hello(&content[0], &hello));
    CHECK(hello.version == FRAME_VERSION);
    CHECK(hello.channels == 3);
    CHECK(hello.analog_inputs == 0b0101);
    CHECK(hello.serial == 0x123456);
    CHECK(count(ecu.frames(), FRAME_HELLO) == 0);
  }
}

TEST_CASE("a DISCOVER to another ECU, or a corrupt one, is not answered") {
  Ecu ecu;
  bus_frame discover;
  frame_pack_discover(&discover, 13);
  CHECK_FALSE(ecu.receive(discover));
  frame_pack_discover(&discover, 12);
  discover.data[0] ^= 1;
  CHECK_FALSE(ecu.receive(discover));
  bus_frame command = Ecu::packed(1, 2000);
  command.id = frame_identifier(FRAME_COMMAND, FRAME_EVERYONE);
  CHECK_FALSE(ecu.receive(command));
  CHECK(count(ecu.frames(), FRAME_HELLO) == 0);
}

TEST_CASE("HELLO contains the same reset cause as the boot frame") {
  Ecu ecu;
  bus_frame boot;
  ecu_link_pack_boot(&ecu.link, FRAME_RESET_BROWN_OUT, &boot);
  const auto content = ecu.frames(true);
  frame_hello hello;
  REQUIRE(frame_unpack_hello(&content[0], &hello));
  CHECK(hello.reset_cause == FRAME_RESET_BROWN_OUT);
}

TEST_CASE("in bus-off both channels trip in the same tick") {
  Ecu ecu;
  ecu_link_bus(&ecu.link, false);
  CHECK(ecu.channel[0].state == ECU_STATE_RUNNING);
  ecu_link_bus(&ecu.link, true);
  for (const ecu_channel& channel : ecu.channel) {
    CHECK(channel.state == ECU_STATE_FAULT);
    CHECK(channel.fault == ECU_FAULT_BUS_OFF);
    CHECK(channel.duty == 0);
  }
}
