#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "interfaces/recording/bytes.hpp"

/// Records of MCAP 0, as specified at mcap.dev: u8 record type (`Op`), u64 length of the body,
/// body. Times are nanoseconds since 1970, or nanoseconds of simulated time.
namespace recording {

inline constexpr std::array<std::uint8_t, 8> magic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
inline constexpr std::size_t record_head_bytes = 9;  ///< record type and length

enum class Op : std::uint8_t {
  header = 1,
  footer,
  schema,
  channel,
  message,
  chunk,
  message_index,
  chunk_index,
  attachment,
  attachment_index,
  statistics,
  metadata,
  metadata_index,
  summary_offset,
  data_end
};

using TextMap = std::map<std::string, std::string>;

/// Type of a channel's messages; for the encoding `ros2msg`, `data` is the schema text.
struct Schema {
  std::uint16_t id = 0;
  std::string name, encoding, data;
  bool operator==(const Schema&) const = default;
};

/// One writer of one topic; its messages have consecutive sequence numbers.
struct Channel {
  std::uint16_t id = 0, schema_id = 0;
  std::string topic, message_encoding;
  TextMap metadata;
  bool operator==(const Channel&) const = default;
};

struct MessageHead {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time_ns = 0, publish_time_ns = 0;
};

struct ChunkHead {
  std::uint64_t start_ns = 0, end_ns = 0, uncompressed_bytes = 0;
  std::uint32_t uncompressed_crc = 0;
  std::string compression;
};

struct ChunkIndex {
  ChunkHead head;
  std::uint64_t offset = 0, length = 0, index_length = 0, compressed_bytes = 0;
  std::map<std::uint16_t, std::uint64_t> index_offsets;
};

/// A file attached to the recording.
struct Attachment {
  std::uint64_t log_time_ns = 0, create_time_ns = 0;
  std::string name, media_type;
  std::string data;
};

struct AttachmentIndex {
  std::uint64_t offset = 0, length = 0, data_bytes = 0;
};

struct Metadata {
  std::string name;
  TextMap values;
};

/// Log time in ns and offset of each message.
using MessageIndex = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

/// Starts a record and returns its position; `end_record` fills in its length.
std::size_t begin_record(Bytes& out, Op op);
void end_record(Bytes& out, std::size_t start);

void put_schema(Bytes& out, const Schema& schema);
void put_channel(Bytes& out, const Channel& channel);
void put_message(Bytes& out, const MessageHead& head, ByteView data);
void put_chunk(Bytes& out, const ChunkHead& head, ByteView records);
void put_message_index(Bytes& out, std::uint16_t channel, const MessageIndex& index);
void put_chunk_index(Bytes& out, const ChunkIndex& index);
void put_attachment(Bytes& out, const Attachment& attachment);
void put_attachment_index(Bytes& out, const AttachmentIndex& index, const Attachment& attachment);
void put_metadata(Bytes& out, const Metadata& metadata);

Schema get_schema(ByteReader& in);
Channel get_channel(ByteReader& in);
MessageHead get_message(ByteReader& in);  ///< the remaining bytes of `in` are the message
ChunkHead get_chunk(ByteReader& in, ByteView& records);
Attachment get_attachment(ByteReader& in);  ///< checks its CRC
Metadata get_metadata(ByteReader& in);

/// CRC-32 of zlib, which MCAP uses for all checksums. `initial_crc`: checksum of the preceding
/// bytes.
std::uint32_t crc32_of(ByteView bytes, std::uint32_t initial_crc = 0);

}  // namespace recording
