#include "launch/erp/run/run_time.hpp"

#include <algorithm>

namespace launch {

void RunTime::on_device_clock(std::int64_t stamp_ns, double real_time_factor) {
  if (last_stamp_ns_ && stamp_ns > *last_stamp_ns_) device_ns_ += stamp_ns - *last_stamp_ns_;
  if (!last_stamp_ns_) first_clock_ns_ = now_ns_;
  last_stamp_ns_ = stamp_ns;
  last_clock_ns_ = now_ns_;
  real_time_factor_ = real_time_factor;
}

double RunTime::device_s() const {
  return last_stamp_ns_ ? 1e-9 * static_cast<double>(device_ns_) : -1;
}

double RunTime::active_s() const {
  if (!last_stamp_ns_ || lockstep_) return device_s();
  return running_since_ns_ ? 1e-9 * static_cast<double>(now_ns_ - *running_since_ns_) : 0;
}

double RunTime::device_delay_s() const {
  if (lockstep_ || !last_stamp_ns_) return 0;
  return 1e-9 * static_cast<double>(last_clock_ns_ - first_clock_ns_) - device_s();
}

double RunTime::remaining_s() const {
  if (duration_s_ <= 0 || !running_since_ns_) return -1;
  if (lockstep_)
    return real_time_factor_ > 0 ? std::max(0.0, duration_s_ - device_s()) / real_time_factor_ : -1;
  const double elapsed_s = 1e-9 * static_cast<double>(now_ns_ - *running_since_ns_);
  return std::max(0.0, duration_s_ - elapsed_s);
}

}  // namespace launch
