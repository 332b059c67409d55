#include "hal/can/outbox.hpp"

#include <catch2/catch.hpp>

#include "tests/allocations.hpp"
#include "tests/hal/can/narrow_bus.hpp"

using namespace can_test;

namespace {

erp::CanFrame command(std::uint8_t ecu, std::int32_t setpoint) {
  const frame_command content{{{3, setpoint}, {FRAME_REQUEST_NONE, 0}}, 0, 0};
  erp::CanFrame frame;
  frame_pack_command(&frame, ecu, &content);
  return frame;
}
std::int32_t setpoint_of(const erp::CanFrame& frame) {
  frame_command content;
  REQUIRE(frame_unpack_command(&frame, &content));
  return content.channel[0].setpoint;
}
erp::CanFrame parameter(std::uint8_t position) {
  const frame_parameter content{0, 1, false, position, 1.5f};
  erp::CanFrame frame;
  frame_pack_parameter(&frame, 3, &content);
  return frame;
}
constexpr std::int64_t ms = 1'000'000, start = 1000 * ms;

}  // namespace

TEST_CASE("only the newest waiting command to an ECU is sent") {
  erp::Outbox outbox;
  NarrowBus bus;
  for (int k = 0; k < 5; ++k) {
    const auto frame = command(3, k);
    outbox.put({&frame, 1}, start);
    outbox.flush(bus, start);
  }
  CHECK(bus.sent_frames.empty());
  CHECK(outbox.replaced() == 4);
  bus.room = 10;
  outbox.flush(bus, start + ms);
  REQUIRE(bus.sent_frames.size() == 1);
  CHECK(setpoint_of(bus.sent_frames[0]) == 4);
  CHECK(outbox.empty());
}

TEST_CASE("a command that was not sent within a tick is never sent") {
  erp::Outbox outbox;
  NarrowBus bus;
  const auto frame = command(3, 1);
  outbox.put({&frame, 1}, start);
  bus.room = 10;
  outbox.flush(bus, start + 2 * ms + 1);
  CHECK(bus.sent_frames.empty());
  CHECK(outbox.expired() == 1);
}

TEST_CASE("commands overtake gains; gains wait in order, and none is lost") {
  erp::Outbox outbox;
  NarrowBus bus;
  for (std::uint8_t position = 0; position < 30; ++position) {
    const auto frame = parameter(position);
    outbox.put({&frame, 1}, 0);
  }
  for (int tick = 0; !outbox.empty(); ++tick) {
    const auto frame = command(3, tick);
    outbox.put({&frame, 1}, start + tick * 2 * ms);
    bus.room = 4;
    outbox.flush(bus, start + tick * 2 * ms);
    REQUIRE(tick < 20);
  }
  REQUIRE(bus.sent_frames.size() == 40);  // 10 ticks of a command and three gains
  std::uint8_t expected = 0;
  for (std::size_t i = 0; i < bus.sent_frames.size(); ++i) {
    frame_parameter content;
    const bool is_gain = frame_unpack_parameter(&bus.sent_frames[i], &content);
    CHECK(is_gain == (i % 4 != 0));
    if (is_gain) CHECK(content.position == expected++);
  }
}

TEST_CASE("in lockstep, at time 0, no command overtakes a gain, and none is replaced") {
  erp::Outbox outbox;
  NarrowBus bus;
  const erp::CanFrame frames[] = {parameter(0), parameter(1), command(3, 1), command(3, 2)};
  for (const auto& frame : frames) {
    outbox.put({&frame, 1}, 0);
    bus.room = 1;
    outbox.flush(bus, 0);
  }
  bus.room = 10;
  outbox.flush(bus, 0);
  REQUIRE(bus.sent_frames.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) CHECK(bus.sent_frames[i].id == frames[i].id);
  CHECK(setpoint_of(bus.sent_frames[3]) == 2);
}

TEST_CASE("dropped frames are counted and not sent later") {
  erp::Outbox outbox;
  NarrowBus bus;
  const erp::CanFrame frames[] = {command(3, 1), command(4, 1), parameter(0)};
  outbox.put(frames, start);
  outbox.drop();
  bus.room = 10;
  outbox.flush(bus, start);
  CHECK(bus.sent_frames.empty());
  CHECK(outbox.expired() == 2);
  CHECK(outbox.dropped() == 1);
}

TEST_CASE("gains beyond the capacity are counted as dropped") {
  erp::Outbox outbox;
  const std::vector<erp::CanFrame> frames(erp::Outbox::max_others + 7, parameter(3));
  outbox.put(frames, 0);
  CHECK(outbox.dropped() == 7);
}

TEST_CASE("an outbox does not use the heap") {
  erp::Outbox outbox;
  NarrowBus bus;
  bus.sent_frames.reserve(1000);
  const erp::CanFrame frames[] = {command(3, 1), command(4, 1), parameter(0)};
  const auto before = tests::allocations();
  for (int tick = 0; tick < 50; ++tick) {
    outbox.put(frames, start + tick * ms);
    bus.room = std::size_t(tick % 5);
    outbox.flush(bus, start + tick * ms);
  }
  CHECK(tests::allocations() == before);
}
