#pragma once
#include <cstdint>

/// Determines from tension and line length whether a tendon is taut.
///
///   slack     below `slack_N` for 16 ms while it should pull
///   snapped   still slack after `take_up_m` of line was wound up; remains until `reset`
///
/// A slack tendon is not a fault: it occurs when a limb is moved by hand, or in a follower.
/// However, a force law on a slack tendon winds without limit.
namespace plant {

enum class TendonState { taut, slack, snapped };

class TendonMonitor {
 public:
  struct Params {
    double slack_N, take_up_m;
  };
  explicit TendonMonitor(const Params& params) : params_(params) {}

  /// Processes one reading. `should_pull`: the request needs more tension than slack. The line
  /// length decreases when the motor winds up.
  TendonState update(double tension_N, double line_m, bool should_pull, std::int64_t now_ns) {
    if (state_ == TendonState::snapped) return state_;
    if (tension_N >= params_.slack_N || !should_pull) {
      reset();
      return state_;
    }
    if (!is_unloaded_) is_unloaded_ = true, slack_since_ns_ = now_ns, slack_line_m_ = line_m;
    if (slack_line_m_ - line_m > params_.take_up_m) state_ = TendonState::snapped;
    else if (now_ns - slack_since_ns_ >= slack_time_ns) state_ = TendonState::slack;
    return state_;
  }
  TendonState state() const { return state_; }
  /// For a motor that no longer pulls: resets the slack timer, but keeps `snapped`.
  void reset_unless_snapped() {
    if (state_ != TendonState::snapped) reset();
  }
  void reset() { state_ = TendonState::taut, is_unloaded_ = false; }

  /// A loss of tension is reported within 20 ms, because readings are up to 4 ms old.
  static constexpr std::int64_t slack_time_ns = 16'000'000;

 private:
  Params params_;
  TendonState state_ = TendonState::taut;
  bool is_unloaded_ = false;
  std::int64_t slack_since_ns_ = 0;
  double slack_line_m_ = 0;  ///< line length when the tendon became slack
};

}  // namespace plant
