#include "components/plant/tendon_monitor.hpp"

namespace plant {

TendonState TendonMonitor::update(double tension_N, double line_m, bool should_pull,
                                  std::int64_t now_ns) {
  if (state_ == TendonState::snapped) return state_;
  if (tension_N >= params_.slack_N || !should_pull) {
    reset();
    return state_;
  }
  if (!slack_) slack_ = true, slack_since_ns_ = now_ns, slack_line_m_ = line_m;
  if (slack_line_m_ - line_m > params_.take_up_m) state_ = TendonState::snapped;
  else if (now_ns - slack_since_ns_ >= slack_time_ns) state_ = TendonState::slack;
  return state_;
}

}  // namespace plant
