#pragma once
#include <string>
#include <vector>

#include "interfaces/recording/cdr.hpp"
#include "interfaces/topics.hpp"

/// The device's side of a recording: its ecu_frames, in the order they were written.
namespace replay {

class Frames {
 public:
  /// Throws std::invalid_argument when the file holds no ecu_frame, recording::RecordingError when
  /// it cannot be read.
  explicit Frames(const std::string& file);
  std::size_t size() const { return messages_.size(); }
  /// The k-th frame as it was recorded: stamp, sequence, channels, analogs.
  erp::EcuFrame at(std::size_t k) const;

 private:
  recording::TypeDescription type_;
  std::vector<recording::Bytes> messages_;
};

}  // namespace replay
