#pragma once
#include <map>
#include <string>
#include <vector>

#include "interfaces/recording/frame_times.hpp"
#include "interfaces/recording/mcap_region.hpp"

/// One pass over an MCAP file: lists its contents and determines whether it is complete. It uses
/// neither summary nor index: the same code reads truncated files.
namespace recording {

/// Statistics of the messages of one channel, in the order of the file.
struct ChannelStatistics {
  std::uint64_t messages = 0;
  std::uint64_t first_ns = 0, last_ns = 0;
  std::uint64_t missing = 0;   ///< skipped sequence numbers
  std::uint64_t restarts = 0;  ///< number of times that the sequence restarted
  std::uint32_t last_sequence = 0;
  std::int64_t first_stamp_ns = 0;
  FrameTimes times;  ///< of the stamps; meaningful for messages in the order of their stamps
  void count(const MessageHead& head);
};

struct Contents {
  std::string profile, library;
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::vector<Attachment> attachments;
  std::vector<Metadata> metadata;
  std::vector<Region> regions;
  std::map<std::uint16_t, ChannelStatistics> statistics;
  std::uint64_t chunks = 0, messages = 0;
  bool complete = false;
  std::string truncation;             ///< position and reason if the file is not complete
  std::vector<std::string> problems;  ///< damage that was skipped (tolerant scans)
};

/// `tolerant`: skips damage and adds it to `problems`; otherwise damage throws RecordingError. A
/// truncated file is not damaged: `complete` is false and `truncation` contains the position.
Contents scan(const InputFile& file, bool tolerant = false);

}  // namespace recording
