#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "interfaces/robot/sensors.hpp"

/// When a sensor looks, and what it says meanwhile: at rate f and latency T,
///
///   said(t) = seen at ⌊(t − T) f⌋ / f        f = 0: at t − T
///
/// and until the first look has arrived, the first look. Both are kept to the instants at which it
/// is offered to look; a rate of which they are no multiple takes the next one.
namespace sim {

template <class Value>
class Sampled {
 public:
  /// `interval_s`: how often it is offered to look, the least.
  Sampled(const erp::Sampling& sampling, double interval_s)
      : period_s_(sampling.rate_Hz > 0 ? 1 / sampling.rate_Hz : 0),
        latency_s_(sampling.latency_s),
        kept_(2 + static_cast<std::size_t>(latency_s_ / std::max(period_s_, interval_s))) {}

  /// False: it looks when asked and says so at once.
  bool timed() const { return period_s_ > 0 || latency_s_ > 0; }

  /// At a time not before the last; `see()` is called if it looks now. No heap.
  template <class See>
  void offer(double time_s, See&& see) {
    if (count_ > 0 && time_s < next_s_ - slack_s) return;
    kept_[count_ % kept_.size()] = {time_s, see()};
    ++count_;
    next_s_ = period_s_ > 0 ? (std::floor((time_s + slack_s) / period_s_) + 1) * period_s_ : time_s;
  }

  struct Seen {
    double time_s = 0;
    Value value{};
  };
  /// The newest that has arrived; offer first.
  const Seen& said(double time_s) const {
    const std::size_t oldest = count_ > kept_.size() ? count_ - kept_.size() : 0;
    std::size_t k = count_ - 1;
    while (k > oldest && !arrived(kept_[k % kept_.size()], time_s)) --k;
    return kept_[k % kept_.size()];
  }
  bool arrived(const Seen& seen, double time_s) const {
    return seen.time_s <= time_s - latency_s_ + slack_s;
  }

 private:
  static constexpr double slack_s = 1e-9;  // rounding of times that were added up
  double period_s_, latency_s_;
  std::vector<Seen> kept_;
  std::size_t count_ = 0;
  double next_s_ = 0;
};

}  // namespace sim
