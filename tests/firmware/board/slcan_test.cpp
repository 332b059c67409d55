#include "firmware/board/slcan.h"

#include <catch2/catch.hpp>
#include <random>
#include <string>
#include <vector>

namespace {

struct ReceivedEvent {
  slcan_event event;
  bus_frame frame;
};
std::vector<ReceivedEvent> receive(slcan_reader& reader, const std::string& text) {
  std::vector<ReceivedEvent> events;
  for (const char c : text) {
    bus_frame frame{};
    const slcan_event event = slcan_take(&reader, std::uint8_t(c), &frame);
    if (event != SLCAN_NOTHING) events.push_back({event, frame});
  }
  return events;
}
std::string to_text(const bus_frame& frame) {
  char text[SLCAN_LINE_MAX];
  return {text, slcan_write(text, &frame)};
}

}  // namespace

TEST_CASE("frames are written as the kernel's slcan writes them") {
  CHECK(to_text({0x181, 8, {0, 0x12, 0xAB, 0, 0, 0, 0, 0xFF}}) == "t18180012AB00000000FF\r");
  CHECK(to_text({0x7FF, 0, {}}) == "t7FF0\r");
}

TEST_CASE("every frame is unchanged by write and read") {
  std::mt19937 random(3);
  slcan_reader reader{};
  for (int k = 0; k < 1000; ++k) {
    bus_frame sent{std::uint16_t(random() % 0x800), std::uint8_t(random() % 9), {}};
    for (int i = 0; i < sent.size; ++i) sent.data[i] = std::uint8_t(random());
    const auto received = receive(reader, to_text(sent));
    REQUIRE(received.size() == 1);
    CHECK(received[0].frame.id == sent.id);
    CHECK(received[0].frame.size == sent.size);
    CHECK(std::equal(sent.data, sent.data + 8, received[0].frame.data));
  }
}

TEST_CASE("open and close commands are reported; other commands are ignored") {
  slcan_reader reader{};
  const auto received = receive(reader, "S8\rO\r\r\rV\rC\r");
  REQUIRE(received.size() == 2);
  CHECK(received[0].event == SLCAN_OPEN);
  CHECK(received[1].event == SLCAN_CLOSE);
  CHECK(reader.unreadable == 0);
}

TEST_CASE("an invalid line is counted, and the next line is read") {
  for (const std::string bad :
       {"t", "t18", "t1819", "t18G80012AB00000000FF", "t8000", "t18120011X", "t1812001",
        "t181200112", "t18180012AB00000000FF0", "t18180012AB00000000FF00000000000000000000"}) {
    slcan_reader reader{};
    INFO(bad);
    const auto received = receive(reader, bad + "\rt0012BEEF\r");
    CHECK(reader.unreadable == 1);
    REQUIRE(received.size() == 1);
    CHECK(received[0].frame.id == 1);
    CHECK(received[0].frame.data[1] == 0xEF);
  }
}
