#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include "interfaces/recording/bytes.hpp"

namespace test {

/// Encodes CDR explicitly, as input of the decoder.
struct CdrWriter {
  explicit CdrWriter(bool little_endian = true) : is_little_endian(little_endian) {
    bytes = {std::byte{0}, std::byte{is_little_endian}, std::byte{0}, std::byte{0}};
  }
  template <class T>
  CdrWriter& put(T value) {
    while ((bytes.size() - 4) % sizeof(T)) bytes.push_back(std::byte{0});
    auto raw = std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
    if (!is_little_endian) std::ranges::reverse(raw);
    recording::put(bytes, raw);
    return *this;
  }
  CdrWriter& string(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    recording::put(bytes, recording::view(text));
    bytes.push_back(std::byte{0});
    return *this;
  }
  recording::Bytes bytes;
  bool is_little_endian;
};

}  // namespace test
