#pragma once
#include <sched.h>

/// Real-time priority (SCHED_FIFO) of the thread that makes this, and of those that it starts, for as
/// long as this lives: what a robot waits for runs before whatever else the machine does. Nothing
/// where it is not wanted, or not permitted.
namespace node {

class RealTime {
 public:
  explicit RealTime(bool wanted);
  ~RealTime();
  RealTime(const RealTime&) = delete;
  RealTime& operator=(const RealTime&) = delete;
  bool on() const { return on_; }

 private:
  bool on_ = false;
  int policy_before_ = 0;
  sched_param before_{};
};

/// Whether this process may: of root, or `ulimit -r` of 5 or more.
bool may_run_in_real_time();

}  // namespace node
