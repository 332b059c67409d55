#pragma once
#include <functional>
#include <string>
#include <vector>

#include "interfaces/recording/mcap_scan.hpp"

namespace recording {

/// One recorded message; valid during the callback only.
struct Message {
  const Channel& channel;
  std::uint32_t sequence;
  std::uint64_t log_time_ns, publish_time_ns;
  ByteView data;
};

enum class Order {
  log_time,  ///< equal times keep the order of the file
  file,      ///< as written, even if the clock of the log times was set back
};

/// Reads an MCAP file of any program (compression none or zstd), complete or truncated.
class McapReader {
 public:
  /// Scans the whole file and verifies its checksums. Throws RecordingError (path, byte, what,
  /// remedy) when it is damaged or not an MCAP file. A truncated file is read up to its end and is
  /// not `complete`.
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

  /// Calls `callback` for every message. With Order::log_time, chunks that overlap in time stay in
  /// memory, up to 256 MB.
  void for_each(const std::function<void(const Message&)>& callback,
                Order order = Order::log_time) const;

 protected:
  McapReader(std::string path, bool tolerant)
      : file_(std::move(path)), contents_(scan(file_, tolerant)) {}

 private:
  void for_each_in_file_order(const std::function<void(const Message&)>& callback) const;
  void emit(const LoadedRegion& region, std::size_t i,
            const std::function<void(const Message&)>& callback) const;

  InputFile file_;
  Contents contents_;
};

struct Recovered {
  std::uint64_t messages = 0, attachments = 0;
  std::vector<std::string> problems;  ///< unreadable parts, with their places
};

/// Copies everything readable in `in` to the new, complete file `out`. Omits each chunk with a
/// wrong checksum: a gap is better than a wrong number. Throws RecordingError when `in` is not an
/// MCAP file, or `out` exists or cannot be written.
Recovered recover(const std::string& in, const std::string& out);

}  // namespace recording
