// Target: arbitrary bytes on the serial line between an ECU and the driver of a CAN adapter.
#include "firmware/board/slcan.h"

#include "tests/fuzz/input.hpp"

namespace {

bool are_equal(const bus_frame& a, const bus_frame& b) {
  return a.id == b.id && a.size == b.size && std::memcmp(a.data, b.data, a.size) == 0;
}

/// Checks that a frame is a classic CAN frame and reads back unchanged from its text.
void check_text(const bus_frame& frame) {
  fuzz::require(frame.id <= 0x7FF && frame.size <= 8, "a frame is a classic CAN frame");
  char text[SLCAN_LINE_MAX];
  const unsigned length = slcan_write(text, &frame);
  fuzz::require(length <= SLCAN_LINE_MAX, "a line has at most 22 characters");
  slcan_reader reader{};
  bus_frame reread_frame{};
  slcan_event last_event = SLCAN_NOTHING;
  for (unsigned i = 0; i < length; ++i) {
    fuzz::require(last_event == SLCAN_NOTHING, "a frame ends at the end of its line");
    last_event = slcan_take(&reader, static_cast<std::uint8_t>(text[i]), &reread_frame);
  }
  fuzz::require(last_event == SLCAN_FRAME && are_equal(reread_frame, frame),
                "a frame reads back unchanged");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  slcan_reader reader{};
  for (std::size_t i = 0; i < size; ++i) {
    bus_frame frame{};
    if (slcan_take(&reader, data[i], &frame) == SLCAN_FRAME) check_text(frame);
  }
  return 0;
}
