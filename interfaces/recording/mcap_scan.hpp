#pragma once
#include <map>
#include <string>
#include <vector>

#include "interfaces/recording/mcap_region.hpp"

/// One walk over an MCAP file, from its first byte to its last: what is in it and whether it is
/// whole. Uses neither summary nor index, so a file that lost its end reads like any other.
namespace recording {

/// What passed through one channel, in the order of the file.
struct ChannelStatistics {
  std::uint64_t messages = 0;
  std::uint64_t first_ns = 0, last_ns = 0;
  std::uint64_t missing = 0;   ///< numbers that were skipped
  std::uint64_t restarts = 0;  ///< times the numbers began again
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
  std::string truncation;             ///< why not complete: place and what
  std::vector<std::string> problems;  ///< damage that was stepped over (tolerant scans)
};

/// `tolerant`: damage is noted and stepped over; otherwise it throws RecordingError. A file that
/// merely ends too early is no damage: `complete` is false and `truncation` says where.
Contents scan(const InputFile& file, bool tolerant = false);

}  // namespace recording
