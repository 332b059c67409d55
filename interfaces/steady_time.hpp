#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>

namespace erp {

/// Time of a sequence of stamps without the steps of the wall clock that made them. A person or a
/// time service may set that clock while messages arrive; an interval between two stamps then has
/// little to do with the time that passed.
///
///   t ← t + (stamp − last stamp)     while the clock was not set
///   t ← t + last interval            the stamp is lower than the last one: the clock was set back
///   t ← t + (interval of arrival)    the stamp advanced by over 0.1 s more than the time of arrival
///                                    explains: the clock was set forward
///
/// Arrival times must come from a clock that is never set. A step forward of less than `tolerance_ns`
/// is not detected, because late messages look the same. No step forward is detected if times of
/// arrival advance less than half as fast as stamps.
class SteadyTime {
 public:
  static constexpr std::int64_t tolerance_ns = 100'000'000;  ///< chosen

  /// The steady time of the next message, in ns; never lower than that of the last message.
  std::int64_t add(std::int64_t stamp_ns, std::int64_t arrival_ns) {
    const std::int64_t offset_ns = stamp_ns - arrival_ns;
    if (!first_) first_ = last_ = {stamp_ns, arrival_ns}, newest_offset_ns_ = offset_ns;
    const std::int64_t interval_ns = stamp_ns - last_->stamp_ns;
    const std::int64_t excess_ns = offset_ns - newest_offset_ns_;
    step_ns_ = 0;
    if (interval_ns < 0) step_ns_ = interval_ns - interval_ns_;
    else if (std::min(interval_ns, excess_ns) > tolerance_ns && arrivals_advance())
      step_ns_ = excess_ns;
    else interval_ns_ = interval_ns;
    shift_ns_ += step_ns_;
    newest_offset_ns_ = std::max(newest_offset_ns_ + step_ns_, offset_ns);
    last_ = {stamp_ns, arrival_ns};
    return stamp_ns - shift_ns_;
  }

  /// By how much the clock was set before the last message; 0: it was not set.
  std::int64_t step_ns() const { return step_ns_; }
  /// Sum of all steps: stamp − steady time.
  std::int64_t shift_ns() const { return shift_ns_; }

 private:
  struct Message {
    std::int64_t stamp_ns, arrival_ns;
  };
  /// Whether arrival times advanced at least half as far as the steady time, up to the last message.
  bool arrivals_advance() const {
    const std::int64_t arrivals_ns = last_->arrival_ns - first_->arrival_ns;
    return arrivals_ns > 0 && 2 * arrivals_ns >= last_->stamp_ns - shift_ns_ - first_->stamp_ns;
  }

  std::optional<Message> first_, last_;
  std::int64_t interval_ns_ = 0;       ///< between the last two stamps without a step
  std::int64_t newest_offset_ns_ = 0;  ///< largest stamp − arrival: that of the smallest delay
  std::int64_t step_ns_ = 0, shift_ns_ = 0;
};

}  // namespace erp
