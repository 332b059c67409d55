#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "interfaces/recording/cdr.hpp"
#include "interfaces/recording/frame_times.hpp"
#include "interfaces/topics.hpp"

/// The ecu_frames of a recording, in the order in which they were written.
namespace replay {

class Frames {
 public:
  /// Throws std::invalid_argument when the file contains no ecu_frame, recording::RecordingError when
  /// it cannot be read.
  explicit Frames(const std::string& file);
  std::size_t size() const { return messages_.size(); }
  /// The k-th recorded frame: stamp, sequence, channels, analogs.
  erp::EcuFrame at(std::size_t k) const;
  /// Time of the k-th frame since the first one, by its stamp without steps of the clock.
  std::int64_t since_start_ns(std::size_t k) const { return times_ns_[k] - times_ns_[0]; }
  /// One line for each time that the clock of the stamps was set.
  std::vector<std::string> clock_steps() const;

 private:
  recording::TypeDescription type_;
  std::vector<recording::Bytes> messages_;
  std::vector<std::int64_t> times_ns_;
  recording::FrameTimes times_;
};

}  // namespace replay
