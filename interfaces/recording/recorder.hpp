#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "interfaces/recording/mcap_writer.hpp"

namespace recording {

/// Type of a topic's messages.
struct MessageType {
  std::string name;    ///< "erp/msg/SensorFrame"
  std::string schema;  ///< ros2msg text; empty: no schema, readable with the IDL only
  std::string idl;     ///< attached as `<name>.idl`; may be empty
};

/// One serialized message from the bus.
struct Sample {
  std::string_view writer;                ///< name of its writer, unique during the recording
  std::uint64_t log_time_ns = 0;          ///< time of recording
  std::uint64_t publish_time_ns = 0;      ///< stamp of the message
  std::optional<std::uint64_t> sequence;  ///< sequence number; gaps are counted
  ByteView cdr;                           ///< including the 4 bytes of encapsulation
};

/// Counts of received and missing messages of a topic.
struct TopicCount {
  std::string topic;
  std::uint64_t messages = 0, missing = 0, restarts = 0, writers = 0;
};

/// The logger without the bus. Writes one MCAP channel per topic and writer: the file then shows
/// every gap in the sequence numbers of a writer. Reads no clock and starts no thread.
class Recorder {
 public:
  /// Writes `attachments` to the disk before the first message. This and `close` throw RecordingError
  /// when writing fails. Between them a failure loses messages, which `lost` counts, and recording
  /// resumes when a write succeeds.
  Recorder(std::string path, const std::vector<Attachment>& attachments, McapOptions options = {});

  /// Returns the topic's handle; the same one for the same topic and type.
  std::size_t add_topic(const std::string& topic, const MessageType& type);
  void write(std::size_t topic, const Sample& sample);

  /// Writes all data to the disk if some of it is older than `flush_period_ns`. Call it at least
  /// ten times per second with a monotonic clock: a killed process then loses at most 0.6 s.
  void tick(std::int64_t monotonic_ns);
  void flush();
  void close();

  const std::vector<TopicCount>& counts() const { return counts_; }
  std::uint64_t missing() const;
  /// See McapWriter.
  const std::string& failure() const { return file_.failure(); }
  const LostMessages& lost() const { return file_.lost(); }
  const std::string& path() const { return file_.path(); }
  std::uint64_t bytes() const { return file_.bytes(); }

  static constexpr std::int64_t flush_period_ns =
      500'000'000;  // chosen: half of the allowed loss, 1 s

 private:
  struct Writer {
    std::uint16_t channel = 0;
    std::optional<std::uint64_t> last_sequence;
  };
  struct Topic {
    std::string name, type;
    std::uint16_t schema = 0;
    std::map<std::string, Writer, std::less<>> writers;
  };
  void attach_idl(const MessageType& type);
  Writer& writer_of(std::size_t topic, std::string_view name);

  McapWriter file_;
  std::vector<Topic> topics_;
  std::vector<TopicCount> counts_;
  std::map<std::string, std::uint16_t> schemas_;  ///< by name and text
  std::set<std::string> idls_;
  bool has_unflushed_data_ = false;  ///< some data is not on the disk yet
  std::optional<std::int64_t> unflushed_since_ns_;
};

}  // namespace recording
