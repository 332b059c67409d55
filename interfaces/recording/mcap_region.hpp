#pragma once
#include <string>

#include "interfaces/recording/file.hpp"
#include "interfaces/recording/mcap_records.hpp"

namespace recording {

/// A part of a file that contains messages: a chunk, or consecutive messages outside chunks.
struct Region {
  std::uint64_t offset = 0, length = 0;  ///< of its records in the file, including their heads
  std::uint64_t first_ns = 0, last_ns = 0;
  std::uint64_t messages = 0;
  bool chunk = false;
  bool truncated = false;  ///< the file ends inside this chunk
  void count(const MessageHead& head);
};

/// The decompressed records of a region, and the positions of its messages, sorted by log time.
struct LoadedRegion {
  Bytes records;
  MessageIndex messages;  ///< log time, offset of the message's record
  std::uint64_t origin = 0;

  /// The i-th message; `data` points into `records`.
  MessageHead message(std::size_t i, std::string_view path, ByteView& data) const;
};

/// Loads a region; of a truncated region only the complete messages. Throws RecordingError when the
/// region is damaged.
LoadedRegion load(const InputFile& file, const Region& region);

struct RecordHead {
  Op op{};
  std::uint64_t length = 0;
};
RecordHead get_record_head(ByteReader& in);

/// The decompressed records of a chunk with the body `in`; verifies size and checksum.
Bytes unpack(ByteReader in);

/// Position of the first valid record at or after `from`; the end of the file if there is none.
/// Only schemas, channels, attachments and chunks count. The lengths inside a valid record add up
/// to its own length.
std::uint64_t next_valid_record(const InputFile& file, std::uint64_t from);

}  // namespace recording
