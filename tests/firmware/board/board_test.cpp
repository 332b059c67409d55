#include "firmware/board/board.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstring>
#include <random>
#include <vector>

#include "firmware/board/wire.h"
#include "tests/firmware/core/channel.hpp"

using namespace firmware;

namespace {

constexpr board_fitted two_channels{5, 0b11, 0b0001, 42};

/// A board and the host's commands to it.
struct Board {
  ecu_board board;
  board_period period{};
  std::array<std::int16_t, 2> duty{};
  std::uint8_t count = 0;

  explicit Board(const board_fitted& fitted = two_channels,
                 frame_reset_cause cause = FRAME_RESET_POWER) {
    ecu_board_init(&board, &fitted, cause, &boot);
    period.readings.channel[0].tension_counts = period.readings.channel[1].tension_counts = 500;
  }
  bus_frame boot;

  std::vector<bus_frame> run_period() {
    std::vector<bus_frame> frames(ECU_LINK_FRAMES_MAX);
    frames.resize(ecu_board_period(&board, &period, duty.data(), frames.data()));
    return frames;
  }
  void send_gains() {
    const auto gains = rig_gains();
    for (std::uint8_t k = 0; k < 2; ++k)
      for (std::uint8_t i = 0; i < ECU_PARAMETER_COUNT; ++i) {
        const frame_parameter content{k, i, i + 1 == ECU_PARAMETER_COUNT, i, gains[i]};
        bus_frame frame;
        frame_pack_parameter(&frame, 5, &content);
        ecu_board_receive(&board, &frame);
      }
  }
  void command(std::uint8_t request, std::int32_t setpoint) {
    const frame_command content{{{request, setpoint}, {request, setpoint}}, 0, count++};
    bus_frame frame;
    frame_pack_command(&frame, 5, &content);
    ecu_board_receive(&board, &frame);
  }
  void run() {
    send_gains();
    command(ECU_REQUEST_ARM, 0);
    run_period();
    command(ECU_REQUEST_VOLTAGE, 1500);
    run_period();
  }
};

}  // namespace

TEST_CASE("a board boots disarmed and reports the cause of the reset") {
  Board board(two_channels, FRAME_RESET_WATCHDOG);
  frame_emergency content;
  REQUIRE(frame_unpack_emergency(&board.boot, &content));
  CHECK(content.boot);
  CHECK(content.reset_cause == FRAME_RESET_WATCHDOG);
  CHECK(board.board.channel[0].state == ECU_STATE_BOOT);
  board.command(ECU_REQUEST_VOLTAGE, 3000);
  board.run_period();
  CHECK(board.duty == std::array<std::int16_t, 2>{0, 0});
}

TEST_CASE("a board drives both channels and sends their state every period") {
  Board board;
  board.run();
  const auto frames = board.run_period();
  CHECK(board.duty[0] == Approx(1023 * 1.5 / 12).margin(1));
  CHECK(board.duty[1] == board.duty[0]);
  frame_status content;
  REQUIRE(frame_unpack_status(&frames.back(), &content));
  CHECK(content.duty == board.duty[1]);
}

TEST_CASE("a channel that is not fitted is neither driven nor reported") {
  Board board({5, 0b10, 0, 0});
  board.run();
  CHECK(board.duty[0] == 0);
  CHECK(board.duty[1] != 0);
  for (const bus_frame& frame : board.run_period())
    CHECK(frame_function_of(&frame) != FRAME_STATUS_0);
}

TEST_CASE("three consecutive overrun periods trip both channels, two do not") {
  Board board;
  board.run();
  for (int k = 0; k < 2; ++k) board.period.overran = true, board.run_period();
  board.period.overran = false, board.run_period();
  CHECK(board.board.channel[0].state == ECU_STATE_RUNNING);
  for (int k = 0; k < 3; ++k) board.period.overran = true, board.run_period();
  CHECK(board.board.channel[0].fault == ECU_FAULT_OVERRUN);
  CHECK(board.duty == std::array<std::int16_t, 2>{0, 0});
  CHECK(board.board.channel[0].overruns == 5);
}

TEST_CASE("in bus-off a board sets PWM to 0 in the same period and rejoins disarmed") {
  Board board;
  board.run();
  board.period.bus_off = true;
  board.run_period();
  CHECK(board.duty == std::array<std::int16_t, 2>{0, 0});
  CHECK(board.board.channel[1].fault == ECU_FAULT_BUS_OFF);
  board.period.bus_off = false;
  board.command(ECU_REQUEST_VOLTAGE, 3000);
  board.run_period();
  CHECK(board.duty == std::array<std::int16_t, 2>{0, 0});
}

TEST_CASE("the potentiometer is read from the analog input given by the gains") {
  Board board;
  board.run();
  board.period.readings.analog[2] = 777;
  board.board.channel[1].gains[ECU_PARAMETER_WIPER_INPUT] = 2;
  board.run_period();
  CHECK(board.board.channel[1].sensed.inputs.potentiometer_counts == 777);
  CHECK(board.board.channel[0].sensed.inputs.potentiometer_counts == 0);
  board.board.channel[1].gains[ECU_PARAMETER_WIPER_INPUT] = -1;
  board.run_period();
  CHECK(board.board.channel[1].sensed.inputs.potentiometer_counts == 0);
}

// ---- messages to external converters ----

namespace {

wire_kind feed(wire_reader& reader, const std::uint8_t* bytes, unsigned size) {
  wire_kind kind{};
  for (unsigned i = 0; i < size; ++i) kind = wire_take(&reader, bytes[i]);
  return kind;
}

board_readings some_readings() {
  board_readings r{};
  r.turn = 255;
  r.channel[0] = {-123456, -2048, 4095, 0, 1, 65535};
  r.channel[1] = {INT32_MIN, 2047, 0, 0, 300, 2};
  r.analog[0] = -8388608, r.analog[3] = 77;
  return r;
}

}  // namespace

TEST_CASE("in lockstep a period waits for the answer and for new readings") {
  Board board;
  board.send_gains();
  auto& readings = board.period.readings;
  CHECK_FALSE(ecu_board_awaits_host(&board.board, &readings));  // turn 0: no lockstep
  readings.turn = 1;
  CHECK_FALSE(ecu_board_awaits_robot(&board.board, &readings));
  const auto content = board.run_period();
  CHECK(ecu_board_awaits_host(&board.board, &readings));
  std::vector<bus_frame> repeated(ECU_LINK_FRAMES_MAX);
  CHECK(ecu_board_repeat(&board.board, repeated.data()) > content.size());  // with all pages
  frame_status status;
  REQUIRE(frame_unpack_status(&content.back(), &status));
  const frame_command answer{{{ECU_REQUEST_ARM, 0}, {ECU_REQUEST_ARM, 0}}, status.counter, 1};
  bus_frame frame;
  frame_pack_command(&frame, 5, &answer);
  ecu_board_receive(&board.board, &frame);
  CHECK_FALSE(ecu_board_awaits_host(&board.board, &readings));
  CHECK(ecu_board_awaits_robot(&board.board, &readings));
  readings.turn = 2;
  CHECK_FALSE(ecu_board_awaits_robot(&board.board, &readings));
}

TEST_CASE("readings, duties and injected faults are unchanged by pack and unpack") {
  wire_reader reader{};
  std::uint8_t bytes[WIRE_MESSAGE_MAX];
  const board_readings sent = some_readings();
  REQUIRE(feed(reader, bytes, wire_pack_readings(bytes, 9, &sent)) == WIRE_READINGS);
  CHECK(wire_ecu(&reader) == 9);
  board_readings received_readings;
  wire_unpack_readings(&reader, &received_readings);
  for (int k = 0; k < 2; ++k) {
    CHECK(received_readings.channel[k].encoder_counts == sent.channel[k].encoder_counts);
    CHECK(received_readings.channel[k].current_counts == sent.channel[k].current_counts);
    CHECK(received_readings.channel[k].tension_counts == sent.channel[k].tension_counts);
    CHECK(received_readings.channel[k].temperature_counts == sent.channel[k].temperature_counts);
    CHECK(received_readings.channel[k].supply_counts == sent.channel[k].supply_counts);
  }
  for (int k = 0; k < 4; ++k) CHECK(received_readings.analog[k] == sent.analog[k]);

  const std::int16_t duty[2] = {-1023, 7};
  REQUIRE(feed(reader, bytes, wire_pack_drive(bytes, 3, duty)) == WIRE_DRIVE);
  std::int16_t received_duty[2];
  wire_unpack_drive(&reader, received_duty);
  CHECK((received_duty[0] == -1023 && received_duty[1] == 7));

  REQUIRE(feed(reader, bytes, wire_pack_sample(bytes, 77, 200)) == WIRE_SAMPLE);
  CHECK(wire_ecu(&reader) == 77);
  CHECK(wire_sample_turn(&reader) == 200);

  const wire_fault fault{WIRE_FAULT_BUSY, 300};
  REQUIRE(feed(reader, bytes, wire_pack_fault(bytes, 3, &fault)) == WIRE_FAULT);
  wire_fault received;
  wire_unpack_fault(&reader, &received);
  CHECK((received.kind == WIRE_FAULT_BUSY && received.periods == 300));
}

TEST_CASE("corrupt messages on a wire are rejected, and later intact ones are received") {
  std::mt19937 random(4);
  wire_reader reader{};
  const board_readings sent = some_readings();
  int intact_messages = 0;
  for (int k = 0; k < 2000; ++k) {
    std::uint8_t bytes[WIRE_MESSAGE_MAX];
    const unsigned size = wire_pack_readings(bytes, 9, &sent);
    if (k % 2) bytes[random() % size] ^= std::uint8_t(1 + random() % 255);
    for (unsigned i = 0; i < size; ++i)
      if (wire_take(&reader, bytes[i]) == WIRE_READINGS) {
        board_readings received_readings;
        wire_unpack_readings(&reader, &received_readings);
        CHECK(std::memcmp(&received_readings, &sent, sizeof received_readings) == 0);
        ++intact_messages;
      }
  }
  CHECK(intact_messages >= 600);  // a corrupt message may corrupt the next one
  CHECK(intact_messages <= 1000);
  CHECK(reader.unreadable > 300);
}
