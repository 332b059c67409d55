#pragma once
#include "firmware/core/frame.h"
#include "tests/fuzz/input.hpp"

namespace fuzz {

/// Gives a frame the envelope that lets its contents be looked at.
inline void seal(bus_frame& frame) {
  frame.id &= 0x7FF;
  frame.size = 8;
  std::uint8_t summed[9] = {static_cast<std::uint8_t>(frame.id & 0xFF),
                            static_cast<std::uint8_t>(frame.id >> 8)};
  std::memcpy(summed + 2, frame.data, 7);
  frame.data[7] = frame_crc8(summed, sizeof summed);
}

/// Identifier 16, size 8, data 8 bytes. A size below 128 stands for a sealed frame: chance alone
/// would never get past the check value.
inline bus_frame take_frame(Input& in) {
  bus_frame frame{};
  frame.id = in.take<std::uint16_t>();
  frame.size = in.take<std::uint8_t>();
  const auto data = in.bytes(sizeof frame.data);
  std::copy(data.begin(), data.end(), frame.data);
  if (frame.size < 128) seal(frame);
  else frame.size = static_cast<std::uint8_t>(frame.size - 128);
  return frame;
}

}  // namespace fuzz
