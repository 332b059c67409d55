#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "interfaces/steady_time.hpp"

namespace recording {

/// Times of the frames of a recording without the steps of the clock that stamped them. Frames are
/// added in the order of the file. A frame that is older in stamp and sequence than the last one is
/// only out of order.
class FrameTimes {
 public:
  /// The clock was set by `by_ns` before the frame at `at_ns`, a steady time.
  struct Step {
    std::int64_t at_ns, by_ns;
  };

  /// The steady time of the next frame, in ns.
  std::int64_t add(std::int64_t stamp_ns, std::uint64_t sequence, std::uint64_t log_time_ns) {
    if (stamp_ns < last_stamp_ns_ && sequence < last_sequence_) return steady_ns(stamp_ns);
    last_stamp_ns_ = stamp_ns, last_sequence_ = sequence;
    const auto at_ns = time_.add(stamp_ns, static_cast<std::int64_t>(log_time_ns));
    if (time_.step_ns()) steps_.push_back({at_ns, time_.step_ns()});
    return at_ns;
  }
  /// The steady time of another message near the last frame.
  std::int64_t steady_ns(std::int64_t stamp_ns) const { return stamp_ns - time_.shift_ns(); }
  const std::vector<Step>& steps() const { return steps_; }

 private:
  erp::SteadyTime time_;
  std::int64_t last_stamp_ns_ = 0;
  std::uint64_t last_sequence_ = 0;
  std::vector<Step> steps_;
};

/// `the clock was set back by 5.000 s, 12.300 s after the first frame`
std::string text_of(const FrameTimes::Step& step, std::int64_t first_ns);

}  // namespace recording
