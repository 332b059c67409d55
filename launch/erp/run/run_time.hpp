#pragma once
#include <cstdint>
#include <optional>

/// How far a run has come, in real time and in its device's. Pure.
namespace launch {

class RunTime {
 public:
  /// `duration_s` of the device's time in lockstep, of real time otherwise; 0: no end.
  RunTime(double duration_s, bool lockstep) : duration_s_(duration_s), lockstep_(lockstep) {}

  void start(std::int64_t now_ns) { started_ns_ = now_ns_ = now_ns; }
  void tick(std::int64_t now_ns) { now_ns_ = now_ns; }
  /// All components are active: the duration counts from the first call.
  void running() { running_since_ns_ = running_since_ns_.value_or(now_ns_); }
  /// A device that was restarted begins at 0 again; what it did before still counts.
  void hear_device(std::int64_t stamp_ns, double real_time_factor);

  std::int64_t now_ns() const { return now_ns_; }
  double elapsed_s() const { return 1e-9 * static_cast<double>(now_ns_ - started_ns_); }
  double device_s() const;  ///< negative: the device was not heard
  /// Since all components were active: of the device's time in lockstep, else of real time.
  /// Negative: the device was not heard.
  double lasted_s() const;
  /// How much less than real time the device's time went on; not of lockstep.
  double behind_s() const;
  /// Real time to go; negative: no end is set, or nobody knows yet.
  double left_s() const;
  /// In real time the run lasts so long, whatever is restarted meanwhile. In lockstep the device
  /// counts.
  bool over() const { return !lockstep_ && running_since_ns_ && duration_s_ > 0 && left_s() <= 0; }

 private:
  double duration_s_;
  bool lockstep_;
  std::int64_t started_ns_ = 0, now_ns_ = 0, device_ns_ = 0;
  std::optional<std::int64_t> running_since_ns_, last_stamp_ns_;
  std::int64_t heard_ns_ = 0, first_heard_ns_ = 0;  ///< when the device spoke last, and first
  double real_time_factor_ = 0;
};

}  // namespace launch
