#pragma once
#include <map>
#include <string>
#include <vector>

#include "interfaces/recording/file.hpp"
#include "interfaces/recording/mcap_records.hpp"

namespace recording {

enum class Compression { none, zstd };

struct McapOptions {
  Compression compression = Compression::zstd;
  std::size_t chunk_bytes = 1u << 20;           ///< size at which a chunk is closed, chosen
  std::uint64_t chunk_span_ns = 1'000'000'000;  ///< span of log times at which it is closed, chosen
  bool replace = false;                         ///< overwrite an existing file
  /// A failed write of a chunk loses its messages and is counted; the next chunk is tried again.
  bool continue_after_failure = false;
};

/// Messages lost because they could not be written.
struct LostMessages {
  std::uint64_t count = 0, first_ns = 0, last_ns = 0;  ///< log times
};

/// Writes an MCAP file: chunks with indexes, attachments, a summary. The current chunk is in memory
/// until it is closed; `flush` writes it to the disk. Every method throws RecordingError (path,
/// system error) when writing fails; the file then ends with its last complete record and accepts
/// no further data. With `continue_after_failure` only the constructor, `attach` and `close` throw. A
/// file that could not be begun is removed.
class McapWriter {
 public:
  explicit McapWriter(std::string path, McapOptions options = {});
  /// Closes the file; prints an error to standard error if that fails. `close` throws it instead.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// Returns the schema's id, from 1.
  std::uint16_t add_schema(std::string name, std::string encoding, std::string data);
  /// Returns the channel's id. `schema_id` 0: a channel without schema.
  /// Throws std::invalid_argument for a schema that was not added.
  std::uint16_t add_channel(std::string topic, std::string message_encoding,
                            std::uint16_t schema_id, TextMap metadata = {});
  /// Throws std::invalid_argument for a channel that was not added.
  void write(std::uint16_t channel, std::uint32_t sequence, std::uint64_t log_time_ns,
             std::uint64_t publish_time_ns, ByteView data);
  void attach(const Attachment& attachment);
  void attach(std::string name, std::string media_type, std::string data);
  void add_metadata(const Metadata& metadata);

  /// Closes the chunk and waits until it is on the disk.
  void flush();
  /// Writes the summary and the footer. Nothing can be added afterwards; a second call does
  /// nothing.
  void close();

  std::uint64_t message_count() const { return messages_; }
  /// Why the last write failed; empty: it succeeded.
  const std::string& failure() const { return failure_; }
  const LostMessages& lost() const { return lost_; }
  const std::string& path() const { return file_.path(); }
  std::uint64_t bytes() const { return file_.size(); }  ///< of the file so far

 private:
  struct Chunk {
    Bytes records;
    std::uint64_t first_ns = 0;              ///< log time of the first message
    std::uint64_t start_ns = 0, end_ns = 0;  ///< smallest and largest log time
    std::map<std::uint16_t, MessageIndex> index;
  };
  void append(const Bytes& bytes);
  void append_or_hold(const Bytes& record);
  void close_chunk();
  void drop_chunk(const WriteError& error);
  void put_summary(Bytes& out);
  void put_statistics(Bytes& out) const;

  McapOptions options_;
  OutputFile file_;
  bool failed_ = false;
  std::string failure_;
  LostMessages lost_;
  Bytes held_;  ///< records that could not be written and that later chunks need
  Chunk chunk_;
  Bytes schema_records_, channel_records_, attachment_records_, metadata_records_;
  std::vector<ChunkIndex> chunks_;
  std::uint16_t schema_count_ = 0, channel_count_ = 0;
  std::uint32_t attachment_count_ = 0, metadata_count_ = 0;
  std::uint64_t messages_ = 0, start_ns_ = 0, end_ns_ = 0;
  std::map<std::uint16_t, std::uint64_t> channel_messages_;
};

}  // namespace recording
