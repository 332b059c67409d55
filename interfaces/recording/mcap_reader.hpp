#pragma once
#include <functional>
#include <string>
#include <vector>

#include "interfaces/recording/mcap_scan.hpp"

namespace recording {

/// One recorded message; all of it lent for the length of the callback.
struct Message {
  const Channel& channel;
  std::uint32_t sequence;
  std::uint64_t log_time_ns, publish_time_ns;
  ByteView data;
};

/// Reads an MCAP file of any writer (compression none or zstd), with or without its end.
class McapReader {
 public:
  /// Walks the whole file and checks its checksums. Throws RecordingError (path, byte, what,
  /// remedy) when it is damaged or no MCAP; a file that only ends too early is read as far as
  /// it goes and is not `complete`.
  explicit McapReader(std::string path) : McapReader(std::move(path), false) {}

  bool complete() const { return contents_.complete; }
  const std::string& truncation() const { return contents_.truncation; }  ///< empty: complete
  const Contents& contents() const { return contents_; }
  const std::map<std::uint16_t, Schema>& schemas() const { return contents_.schemas; }
  const std::map<std::uint16_t, Channel>& channels() const { return contents_.channels; }
  const std::vector<Attachment>& attachments() const { return contents_.attachments; }
  const std::map<std::uint16_t, ChannelStatistics>& statistics() const {
    return contents_.statistics;
  }
  const std::string& path() const { return file_.path(); }

  /// Every message in the order of log times; of equal times, in the order of the file.
  /// Holds chunks that overlap in time in memory, up to 256 MB of them.
  void for_each(const std::function<void(const Message&)>& use) const;

 protected:
  McapReader(std::string path, bool tolerant)
      : file_(std::move(path)), contents_(scan(file_, tolerant)) {}

 private:
  void emit(const LoadedRegion& region, std::size_t i,
            const std::function<void(const Message&)>& use) const;

  InputFile file_;
  Contents contents_;
};

struct Recovered {
  std::uint64_t messages = 0, attachments = 0;
  std::vector<std::string> problems;  ///< what could not be read, and where
};

/// Copies everything that can be read of `in` into the new, complete file `out`. A chunk whose
/// checksum fails is left out whole: a gap is better than a wrong number.
/// Throws RecordingError when `in` is no MCAP file, or `out` exists or cannot be written.
Recovered recover(const std::string& in, const std::string& out);

}  // namespace recording
