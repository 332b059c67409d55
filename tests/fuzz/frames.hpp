#pragma once
#include "firmware/core/frame.h"
#include "tests/fuzz/input.hpp"

namespace fuzz {

/// Sets identifier range, size and CRC of a frame, so that the receiver accepts it.
inline void make_intact(bus_frame& frame) {
  frame.id &= 0x7FF;
  frame.size = 8;
  std::uint8_t checked_bytes[9] = {static_cast<std::uint8_t>(frame.id & 0xFF),
                                   static_cast<std::uint8_t>(frame.id >> 8)};
  std::memcpy(checked_bytes + 2, frame.data, 7);
  frame.data[7] = frame_crc8(checked_bytes, sizeof checked_bytes);
}

/// Reads a frame: identifier 16 bits, size 8 bits, data 8 bytes. A size byte below 128 selects a
/// frame with a valid CRC, which random bytes would not have.
inline bus_frame take_frame(Input& in) {
  bus_frame frame{};
  frame.id = in.take<std::uint16_t>();
  frame.size = in.take<std::uint8_t>();
  const auto data = in.bytes(sizeof frame.data);
  std::copy(data.begin(), data.end(), frame.data);
  if (frame.size < 128) make_intact(frame);
  else frame.size = static_cast<std::uint8_t>(frame.size - 128);
  return frame;
}

}  // namespace fuzz
