#include "firmware/board/outbox.h"

#include <catch2/catch.hpp>
#include <vector>

namespace {

bus_frame frame_of(frame_function function, std::uint8_t mark) {
  return {frame_identifier(function, 5), 8, {mark}};
}
std::vector<int> take_marks(ecu_outbox& outbox) {
  std::vector<int> marks;
  while (const bus_frame* next = outbox_next(&outbox)) {
    marks.push_back(next->data[0]);
    outbox_sent(&outbox);
  }
  return marks;
}

}  // namespace

TEST_CASE("frames are sent in the order of their period") {
  ecu_outbox outbox{};
  const bus_frame period[] = {frame_of(FRAME_EMERGENCY, 1), frame_of(FRAME_STATUS_0, 2),
                              frame_of(FRAME_STATUS_1, 3)};
  outbox_put(&outbox, period, 3);
  CHECK(take_marks(outbox) == std::vector<int>{1, 2, 3});
  CHECK(outbox.dropped == 0);
}

TEST_CASE("unsent frames of a period are replaced by the next period, except emergencies") {
  ecu_outbox outbox{};
  const bus_frame first[] = {frame_of(FRAME_EMERGENCY, 1), frame_of(FRAME_STATUS_0, 2)};
  const bus_frame second[] = {frame_of(FRAME_STATUS_0, 3), frame_of(FRAME_STATUS_1, 4)};
  outbox_put(&outbox, first, 2);
  outbox_put(&outbox, second, 2);
  CHECK(take_marks(outbox) == std::vector<int>{1, 3, 4});
  CHECK(outbox.dropped == 1);
}

TEST_CASE("during a long bus outage the first emergencies and all frames of one period are kept") {
  ecu_outbox outbox{};
  for (int k = 0; k < 100; ++k) {
    std::vector<bus_frame> period{frame_of(FRAME_EMERGENCY, std::uint8_t(k))};
    period.resize(ECU_LINK_FRAMES_MAX, frame_of(FRAME_STATUS_0, std::uint8_t(k)));
    outbox_put(&outbox, period.data(), unsigned(period.size()));
  }
  const auto remaining_marks = take_marks(outbox);
  REQUIRE(remaining_marks.size() == OUTBOX_EMERGENCIES_MAX + ECU_LINK_FRAMES_MAX);
  for (int k = 0; k < int(OUTBOX_EMERGENCIES_MAX); ++k) CHECK(remaining_marks[std::size_t(k)] == k);
  CHECK(remaining_marks.back() == 99);
  outbox_sent(&outbox);  // no effect on an empty outbox
  CHECK(outbox.count == 0);
}
