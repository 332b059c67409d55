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
        slack_s_(1e-3 * interval_s),
        kept_(2 + static_cast<std::size_t>(latency_s_ / std::max(period_s_, interval_s))) {}

  /// False: it looks when asked and says so at once.
  bool timed() const { return period_s_ > 0 || latency_s_ > 0; }

  /// `see()` is called if it looks now. A time before the last begins anew. No heap.
  template <class See>
  void offer(double time_s, See&& see) {
    if (time_s < offered_s_) count_ = 0;
    offered_s_ = time_s;
    if (period_s_ > 0 && count_ > 0 && time_s < next_s_ - slack_s_) return;
    kept_[count_ % kept_.size()] = {time_s, see()};
    ++count_;
    if (period_s_ > 0) next_s_ = (std::floor((time_s + slack_s_) / period_s_) + 1) * period_s_;
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
    return seen.time_s <= time_s - latency_s_ + slack_s_;
  }

 private:
  double period_s_, latency_s_, slack_s_;  ///< slack: of times that are rounded
  std::vector<Seen> kept_;
  std::size_t count_ = 0;
  double next_s_ = 0, offered_s_ = 0;
};

}  // namespace sim
