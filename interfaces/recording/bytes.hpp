#pragma once
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interfaces/recording/error.hpp"

/// Little-endian encoding of MCAP.
namespace recording {

using Bytes = std::vector<std::byte>;
using ByteView = std::span<const std::byte>;

inline ByteView view(std::string_view text) { return std::as_bytes(std::span(text)); }
inline std::string_view text(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

inline void put(Bytes& out, ByteView bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); }

template <std::unsigned_integral T>
void put(Bytes& out, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i)
    out.push_back(static_cast<std::byte>(static_cast<std::uint64_t>(value) >> (8 * i)));
}

/// Appends the length as u32, then the characters.
inline void put(Bytes& out, std::string_view characters) {
  put(out, static_cast<std::uint32_t>(characters.size()));
  put(out, view(characters));
}

/// Reads forward through the bytes of a file, with bounds checks.
class ByteReader {
 public:
  /// `in_chunk`: the bytes are the decompressed records of a chunk. `origin`: position of the bytes
  /// in the file, or of their chunk. `bytes` and `path` must outlive the reader.
  ByteReader(ByteView bytes, std::string_view path, std::uint64_t origin, bool in_chunk = false)
      : bytes_(bytes), path_(path), origin_(origin), in_chunk_(in_chunk) {}

  template <std::unsigned_integral T>
  T integer(const char* what) {
    std::uint64_t value = 0;
    const ByteView raw = take(sizeof(T), what);
    for (std::size_t i = 0; i < sizeof(T); ++i)
      value |= static_cast<std::uint64_t>(std::to_integer<std::uint8_t>(raw[i])) << (8 * i);
    return static_cast<T>(value);
  }
  std::string characters(const char* what) {
    return std::string(text(take(integer<std::uint32_t>(what), what)));
  }
  /// Removes and returns the next `size` bytes. `what` names them in the error. Throws
  /// RecordingError when fewer bytes remain.
  ByteView take(std::uint64_t size, const char* what) {
    if (size > bytes_.size() - position_)
      fail(std::string(what) + " needs " + std::to_string(size) + " bytes, its record has " +
           std::to_string(bytes_.size() - position_) + " left");
    const ByteView taken = bytes_.subspan(position_, static_cast<std::size_t>(size));
    position_ += taken.size();
    return taken;
  }
  /// Removes the next `size` bytes and returns a reader of them.
  ByteReader part(std::uint64_t size, const char* what) {
    const std::uint64_t start = file_position();
    return {take(size, what), path_, start, in_chunk_};
  }
  ByteView rest() { return take(bytes_.size() - position_, "the rest"); }
  bool empty() const { return position_ == bytes_.size(); }
  std::size_t position() const { return position_; }
  /// Position in the file; inside a chunk, the position of the chunk.
  std::uint64_t file_position() const { return in_chunk_ ? origin_ : origin_ + position_; }
  [[noreturn]] void fail(const std::string& what) const {
    throw error_at(path_, file_position(), what + (in_chunk_ ? " (inside this chunk)" : ""),
                   recover_remedy(path_));
  }

 private:
  ByteView bytes_;
  std::string_view path_;
  std::uint64_t origin_;
  bool in_chunk_;
  std::size_t position_ = 0;
};

}  // namespace recording
