#pragma once
#include <cstdint>
#include <optional>

/// Elapsed and remaining time of a run, in real time and device time. Reads no clock.
namespace launch {

class RunTime {
 public:
  /// `duration_s`: device time in lockstep, real time otherwise; 0: no limit.
  RunTime(double duration_s, bool lockstep) : duration_s_(duration_s), lockstep_(lockstep) {}

  void start(std::int64_t now_ns) { started_ns_ = now_ns_ = now_ns; }
  void tick(std::int64_t now_ns) { now_ns_ = now_ns; }
  /// Reports that all components are active. The duration counts from the first call.
  void running() { running_since_ns_ = running_since_ns_.value_or(now_ns_); }
  /// The clock of a restarted device begins at 0; the device time before the restart still counts.
  void on_device_clock(std::int64_t stamp_ns, double real_time_factor);

  std::int64_t now_ns() const { return now_ns_; }
  double elapsed_s() const { return 1e-9 * static_cast<double>(now_ns_ - started_ns_); }
  double device_s() const;  ///< negative: no clock message received
  /// Time since all components became active: device time in lockstep, otherwise real time.
  /// Negative: no clock message received.
  double active_s() const;
  /// Delay of device time relative to real time; 0 in lockstep.
  double device_delay_s() const;
  /// Remaining real time; negative: there is no limit, or it is not known yet.
  double remaining_s() const;
  /// Whether the duration has passed in real time, regardless of restarts. Always false in
  /// lockstep, where the device ends the run.
  bool is_over() const {
    return !lockstep_ && running_since_ns_ && duration_s_ > 0 && remaining_s() <= 0;
  }

 private:
  double duration_s_;
  bool lockstep_;
  std::int64_t started_ns_ = 0, now_ns_ = 0, device_ns_ = 0;
  std::optional<std::int64_t> running_since_ns_, last_stamp_ns_;
  std::int64_t last_clock_ns_ = 0,
               first_clock_ns_ = 0;  ///< arrival of the last and first clock message
  double real_time_factor_ = 0;
};

}  // namespace launch
