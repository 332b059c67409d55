#include "firmware/core/bundle.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <vector>

namespace {

bus_frame command_to(std::uint8_t ecu) {
  const frame_command content{{{3, 1000 + ecu}, {4, -5}}, 1, 2};
  bus_frame frame;
  frame_pack_command(&frame, ecu, &content);
  return frame;
}

bus_frame hello_of(std::uint8_t ecu) {
  const frame_hello content{FRAME_VERSION, 3, 5, FRAME_RESET_WATCHDOG, 0xABCDEF};
  bus_frame frame;
  frame_pack_hello(&frame, ecu, &content);
  return frame;
}

bool same(const bus_frame& a, const bus_frame& b) {
  return a.id == b.id && a.size == b.size && std::memcmp(a.data, b.data, 8) == 0;
}

/// Packs into bundles and unpacks them.
std::vector<bus_frame> through_bundles(const std::vector<bus_frame>& frames, int& bundles) {
  std::vector<bus_frame> received;
  bundles = 0;
  for (std::size_t first = 0; first < frames.size(); ++bundles) {
    bus_bundle bundle;
    first += bundle_pack(&bundle, &frames[first], unsigned(frames.size() - first));
    bus_frame unpacked[BUNDLE_FRAMES_MAX];
    const unsigned count = bundle_unpack(&bundle, unpacked);
    received.insert(received.end(), unpacked, unpacked + count);
  }
  return received;
}

}  // namespace

TEST_CASE("any number of frames is unchanged and in order after bundling and unbundling") {
  for (unsigned count = 1; count <= 20; ++count) {
    std::vector<bus_frame> frames;
    for (unsigned i = 0; i < count; ++i) frames.push_back(command_to(std::uint8_t(i)));
    int bundles = 0;
    const auto received = through_bundles(frames, bundles);
    REQUIRE(received.size() == count);
    for (unsigned i = 0; i < count; ++i) CHECK(same(received[i], frames[i]));
    CHECK(bundles == int((count + 5) / 6));
  }
}

TEST_CASE("only frames of one function or of one ECU share a bundle") {
  int bundles = 0;
  through_bundles({command_to(1), hello_of(1), hello_of(2)}, bundles);
  CHECK(bundles == 2);  // COMMAND and HELLO of ECU 1; HELLO of ECU 2
  through_bundles({hello_of(2), hello_of(1), command_to(2), command_to(1)}, bundles);
  CHECK(bundles == 2);  // the third frame is from ECU 2, the fourth from another
}

TEST_CASE("a bundle has a CAN FD size and the identifier of its first frame") {
  const std::vector<bus_frame> frames(6, command_to(9));
  const int sizes[] = {12, 20, 32, 48, 64, 64};
  for (unsigned count = 1; count <= 6; ++count) {
    bus_bundle bundle;
    REQUIRE(bundle_pack(&bundle, frames.data(), count) == count);
    CHECK(bundle.size == sizes[count - 1]);
    CHECK(bundle.id == frames[0].id);
  }
  CHECK(bundle_size(7) == 64);
}

TEST_CASE("an invalid bundle contains no frames") {
  bus_frame unpacked[BUNDLE_FRAMES_MAX];
  bus_bundle bundle{};
  bundle.size = 9;  // too short for one frame
  CHECK(bundle_unpack(&bundle, unpacked) == 0);
  bundle.size = 65;
  CHECK(bundle_unpack(&bundle, unpacked) == 0);
  const bus_frame frame = command_to(1);
  bundle_pack(&bundle, &frame, 1);
  bundle.id ^= 1;  // not the identifier of its first frame
  CHECK(bundle_unpack(&bundle, unpacked) == 0);
  std::memset(bundle.data, 0xFF, sizeof bundle.data);
  CHECK(bundle_unpack(&bundle, unpacked) == 0);
}
