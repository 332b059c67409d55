#pragma once
#include <map>
#include <string>
#include <vector>

#include "interfaces/recording/mcap_region.hpp"

/// One pass over an MCAP file: lists its contents and determines whether it is complete. Uses neither
/// summary nor index, so truncated files are read by the same code.
namespace recording {

/// Statistics of the messages of one channel, in the order of the file.
struct ChannelStatistics {
  std::uint64_t messages = 0;
  std::uint64_t first_ns = 0, last_ns = 0;
  std::uint64_t missing = 0;   ///< skipped sequence numbers
  std::uint64_t restarts = 0;  ///< number of times that the sequence restarted
  std::uint32_t last_sequence = 0;
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
  std::string truncation;             ///< why the file is not complete: place and reason
  std::vector<std::string> problems;  ///< damage that was skipped (tolerant scans)
};

/// `tolerant`: stores damage in `problems` and skips it; otherwise damage throws RecordingError. A
/// truncated file is not damage: `complete` is then false and `truncation` contains the place.
Contents scan(const InputFile& file, bool tolerant = false);

}  // namespace recording
