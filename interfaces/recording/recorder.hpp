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

/// How a topic's messages look.
struct MessageType {
  std::string name;    ///< "erp/msg/SensorFrame"
  std::string schema;  ///< ros2msg text; empty: kept without, readable with the IDL only
  std::string idl;     ///< attached as `<name>.idl`; may be empty
};

/// One message as it came off the bus.
struct Sample {
  std::string_view writer;                ///< who wrote it, unique in the recording's time
  std::uint64_t log_time_ns = 0;          ///< when the recorder had it
  std::uint64_t publish_time_ns = 0;      ///< its own stamp
  std::optional<std::uint64_t> sequence;  ///< its number; gaps in it are counted
  ByteView cdr;                           ///< with the 4 bytes of encapsulation
};

/// What came in on a topic, and what did not.
struct TopicCount {
  std::string topic;
  std::uint64_t messages = 0, missing = 0, restarts = 0, writers = 0;
};

/// The logger without its bus: one MCAP channel per topic and writer, so that every gap in a
/// writer's numbers stays visible in the file. It reads no clock and starts no thread.
class Recorder {
 public:
  /// `attachments` are on the disk before the first message. Throws RecordingError, as every
  /// method, when the disk refuses.
  Recorder(std::string path, const std::vector<Attachment>& attachments, McapOptions options = {});

  /// Returns the topic's handle; the same one for the same topic and type.
  std::size_t add_topic(const std::string& topic, const MessageType& type);
  void write(std::size_t topic, const Sample& sample);

  /// Puts what is older than `flush_period_ns` on the disk. Call it ten times a second or more, on
  /// a clock that always advances: a killed process then loses 0.6 s at most.
  void tick(std::int64_t monotonic_ns);
  void flush();
  void close();

  const std::vector<TopicCount>& counts() const { return counts_; }
  std::uint64_t missing() const;

  static constexpr std::int64_t flush_period_ns = 500'000'000;  // chosen: half of what may be lost

 private:
  struct Writer {
    std::uint16_t channel = 0;
    std::optional<std::uint64_t> last;
  };
  struct Topic {
    std::string name, type;
    std::uint16_t schema = 0;
    std::map<std::string, Writer, std::less<>> writers;
  };
  Writer& writer_of(std::size_t topic, std::string_view name);

  McapWriter file_;
  std::vector<Topic> topics_;
  std::vector<TopicCount> counts_;
  std::map<std::string, std::uint16_t> schemas_;  ///< by name and text
  std::set<std::string> idls_;
  bool waiting_ = false;  ///< something is not on the disk yet
  std::optional<std::int64_t> waiting_since_ns_;
};

}  // namespace recording
