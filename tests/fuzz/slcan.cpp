// Any bytes on the serial line between an ECU and a CAN adapter's driver.
#include "firmware/board/slcan.h"

#include "tests/fuzz/input.hpp"

namespace {

bool same(const bus_frame& a, const bus_frame& b) {
  return a.id == b.id && a.size == b.size && std::memcmp(a.data, b.data, a.size) == 0;
}

/// A frame is one of the bus, and the same after another journey as text.
void travels(const bus_frame& frame) {
  fuzz::require(frame.id <= 0x7FF && frame.size <= 8, "a frame is a classic one");
  char text[SLCAN_LINE_MAX];
  const unsigned length = slcan_write(text, &frame);
  fuzz::require(length <= SLCAN_LINE_MAX, "a line is 22 characters at most");
  slcan_reader reader{};
  bus_frame again{};
  slcan_event last = SLCAN_NOTHING;
  for (unsigned i = 0; i < length; ++i) {
    fuzz::require(last == SLCAN_NOTHING, "a frame ends with its line");
    last = slcan_take(&reader, static_cast<std::uint8_t>(text[i]), &again);
  }
  fuzz::require(last == SLCAN_FRAME && same(again, frame), "a frame reads as it was written");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  slcan_reader reader{};
  for (std::size_t i = 0; i < size; ++i) {
    bus_frame frame{};
    if (slcan_take(&reader, data[i], &frame) == SLCAN_FRAME) travels(frame);
  }
  return 0;
}
