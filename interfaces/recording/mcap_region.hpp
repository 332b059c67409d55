#pragma once
#include <string>

#include "interfaces/recording/file.hpp"
#include "interfaces/recording/mcap_records.hpp"

namespace recording {

/// A stretch of file with messages: a chunk, or messages between chunks.
struct Region {
  std::uint64_t offset = 0, length = 0;  ///< of its records in the file, heads included
  std::uint64_t first_ns = 0, last_ns = 0;
  std::uint64_t messages = 0;
  bool chunk = false;
  bool cut = false;  ///< the file ends inside this chunk
  void count(const MessageHead& head);
};

/// A region's records, decompressed, and where each message stands in them, by log time.
struct LoadedRegion {
  Bytes records;
  MessageIndex messages;  ///< log time, offset of the message's record
  std::uint64_t origin = 0;

  /// The i-th message; `data` points into `records`.
  MessageHead message(std::size_t i, std::string_view path, ByteView& data) const;
};

/// Throws RecordingError when the region is damaged. Of a cut one, what is there of it.
LoadedRegion load(const InputFile& file, const Region& region);

struct RecordHead {
  Op op{};
  std::uint64_t length = 0;
};
RecordHead get_record_head(ByteReader& in);

/// The decompressed records of the chunk whose body `in` is; checks size and checksum.
Bytes unpack(ByteReader in);

/// Where, from `from` on, the next record stands that is whole beyond doubt: a schema, channel,
/// attachment or chunk whose inner lengths fill it exactly. The end of the file when none does.
std::uint64_t next_sound_record(const InputFile& file, std::uint64_t from);

}  // namespace recording
