#pragma once
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "hal/can/bus.hpp"

namespace erp {

/// One frame of a trace.
struct TraceLine {
  double time_s = 0;  ///< since 1970, or since the recorder's own epoch
  std::string interface;
  CanFrame frame{};
};

/// One line of `candump -L`: `(1436509053.850870) can0 123#DEADBEEF`.
/// Empty for any other text, and for 29-bit, remote, FD and error frames.
std::optional<TraceLine> parse_trace_line(const std::string& line);

/// The same line as candump writes it, with microseconds; ends with a newline.
std::string trace_line(const CanFrame& frame, std::int64_t stamp_ns, const std::string& interface);

/// Writes every frame of a bus, received or sent, in the format of `candump -L`, for tools that
/// read it (canplayer, log2asc, Wireshark, SavvyCAN) and for `trace:FILE`. A CAN FD bundle is
/// written as the classic frames it contains.
class TraceWriter : public FrameSink {
 public:
  /// Throws std::runtime_error when the file cannot be written.
  TraceWriter(const std::string& file, std::string interface);
  void frame(const CanFrame& frame, std::int64_t stamp_ns, bool is_own) override;
  /// Frames that could not be written, for example because the disk is full.
  std::uint64_t lost() const { return lost_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::string interface_;
  std::uint64_t lost_ = 0;
};

}  // namespace erp
