#include "interfaces/recording/frame_times.hpp"

#include <cstdio>
#include <cstdlib>

namespace recording {

std::string text_of(const FrameTimes::Step& step, std::int64_t first_ns) {
  char text[96];
  std::snprintf(text, sizeof text, "the clock was set %s by %.3f s, %.3f s after the first frame",
                step.by_ns < 0 ? "back" : "forward",
                1e-9 * static_cast<double>(std::abs(step.by_ns)),
                1e-9 * static_cast<double>(step.at_ns - first_ns));
  return text;
}

}  // namespace recording
