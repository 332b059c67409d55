#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "interfaces/robot/sensors.hpp"

/// Zero-order hold of a sensor with sampling rate f and latency T:
///
///   reading(t) = value at ⌊(t − T) f⌋ / f        f = 0: value at t − T
///
/// Until the first sample has arrived, the reading is the first sample. Samples are taken only at the
/// instants of the calls of `offer`; a sampling instant between two calls moves to the later one.
namespace sim {

template <class Value>
class Sampled {
 public:
  /// `interval_s`: shortest time between two calls of `offer`.
  Sampled(const erp::Sampling& sampling, double interval_s)
      : period_s_(sampling.rate_Hz > 0 ? 1 / sampling.rate_Hz : 0),
        latency_s_(sampling.latency_s),
        slack_s_(1e-3 * interval_s),
        samples_(2 + static_cast<std::size_t>(latency_s_ / std::max(period_s_, interval_s))) {}

  /// False: neither rate nor latency; the sensor is read directly.
  bool timed() const { return period_s_ > 0 || latency_s_ > 0; }

  /// Calls `take()` if a sample is due. A time before the previous one resets the samples. No heap.
  template <class Take>
  void offer(double time_s, Take&& take) {
    if (time_s < last_offer_s_) count_ = 0;
    last_offer_s_ = time_s;
    if (period_s_ > 0 && count_ > 0 && time_s < next_s_ - slack_s_) return;
    samples_[count_ % samples_.size()] = {time_s, take()};
    ++count_;
    if (period_s_ > 0) next_s_ = (std::floor((time_s + slack_s_) / period_s_) + 1) * period_s_;
  }

  struct Sample {
    double time_s = 0;
    Value value{};
  };
  /// The latest sample that has arrived. Requires an earlier call of `offer`.
  const Sample& latest(double time_s) const {
    const std::size_t oldest = count_ > samples_.size() ? count_ - samples_.size() : 0;
    std::size_t k = count_ - 1;
    while (k > oldest && !arrived(samples_[k % samples_.size()], time_s)) --k;
    return samples_[k % samples_.size()];
  }
  bool arrived(const Sample& sample, double time_s) const {
    return sample.time_s <= time_s - latency_s_ + slack_s_;
  }

 private:
  double period_s_, latency_s_, slack_s_;  ///< slack: tolerance for rounded times
  std::vector<Sample> samples_;
  std::size_t count_ = 0;
  double next_s_ = 0, last_offer_s_ = 0;
};

}  // namespace sim
