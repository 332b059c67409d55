#pragma once
#include <string>
#include <vector>

#include "interfaces/recording/cdr.hpp"
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

 private:
  recording::TypeDescription type_;
  std::vector<recording::Bytes> messages_;
};

}  // namespace replay
