// Target: arbitrary bytes on the line between an ECU and its simulated robot.
#include "firmware/board/wire.h"

#include "tests/fuzz/input.hpp"

namespace {

/// Encodes the decoded message of `reader` into `bytes`. Returns the number of bytes.
unsigned encode_decoded(wire_kind kind, const wire_reader& reader, std::uint8_t* bytes) {
  const std::uint8_t ecu = wire_ecu(&reader);
  board_readings readings;
  wire_fault fault;
  std::int16_t duty[2];
  switch (kind) {
    case WIRE_READINGS:
      wire_unpack_readings(&reader, &readings);
      return wire_pack_readings(bytes, ecu, &readings);
    case WIRE_DRIVE:
      wire_unpack_drive(&reader, duty);
      return wire_pack_drive(bytes, ecu, duty);
    case WIRE_FAULT:
      wire_unpack_fault(&reader, &fault);
      return wire_pack_fault(bytes, ecu, &fault);
    case WIRE_SAMPLE:
      return wire_pack_sample(bytes, ecu, wire_sample_turn(&reader));
  }
  fuzz::require(false, "a message has a known kind");
  return 0;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  wire_reader reader{};
  std::uint8_t encoded[WIRE_MESSAGE_MAX];
  for (std::size_t i = 0; i < size; ++i) {
    const wire_kind kind = wire_take(&reader, data[i]);
    if (kind == wire_kind{}) continue;
    const unsigned length = encode_decoded(kind, reader, encoded);
    fuzz::require(length <= i + 1 && std::memcmp(encoded, data + i + 1 - length, length) == 0,
                  "a decoded message encodes to the same bytes");
  }
  return 0;
}
