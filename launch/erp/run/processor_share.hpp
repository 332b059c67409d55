#pragma once
#include <sys/types.h>

#include <cstdint>

/// Processor load of a process, from /proc/PID/stat.
namespace launch {

class ProcessorShare {
 public:
  /// Percent of one core, averaged over at least 0.5 s; calls in between return the previous value.
  /// −1 at the first call for a process or when it has ended.
  double measure(pid_t pid, std::int64_t now_ns);

 private:
  pid_t pid_ = 0;
  std::int64_t last_ns_ = 0;
  double last_busy_s_ = 0;
  double percent_ = -1;
};

}  // namespace launch
