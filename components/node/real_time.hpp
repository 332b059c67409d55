#pragma once
#include <sched.h>

/// Real-time priority (SCHED_FIFO) of the current thread, and of threads that it starts, during the
/// lifetime of this object. The control loop then preempts other programs. Has no effect if not
/// enabled or not permitted.
namespace node {

class RealTimePriority {
 public:
  explicit RealTimePriority(bool enable);
  ~RealTimePriority();
  RealTimePriority(const RealTimePriority&) = delete;
  RealTimePriority& operator=(const RealTimePriority&) = delete;
  bool on() const { return on_; }

 private:
  bool on_ = false;
  int policy_before_ = 0;
  sched_param parameters_before_{};
};

/// True if this process is permitted to use real-time priority: as root, or with `ulimit -r` of 5
/// or more.
bool may_run_in_real_time();

}  // namespace node
