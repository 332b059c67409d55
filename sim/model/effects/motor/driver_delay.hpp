#pragma once
#include <algorithm>
#include <cstddef>
#include <span>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Delay between the voltage that the controller reports and the voltage that the driver applies.
///
///   V'(t) = V(t − T)            applied as the mean over a step
///
/// At most three voltage changes are pending, so the bound is three periods of a controller at 500
/// Hz.
/// Ignores: with a faster controller a fourth change may occur earlier; the oldest then acts at
/// once.
/// Source: dead time and PWM update delay, Holtz, Proc. IEEE 82, 1994.
struct MotorDriverDelay {
  static constexpr About about{"motor_driver_delay", Stage::motor, Seat::actuator,
                               "a voltage that changes from row to row"};

  double delay_s = 0;  // T

  void visit(auto& v) { v("delay_s", delay_s, Bounds{0, 0.006}); }

  double driver_delay_s() const { return delay_s; }
  double delayed_voltage_V(double applied_V, const ChainSample& s, Memory& memory) const {
    Pending pending(memory);
    if (!pending.started()) pending.start(applied_V);
    for (std::size_t n = 0; n < pending.count(); ++n) pending.age_s(n) += s.dt_s;
    if (applied_V != pending.newest_V()) pending.add(applied_V, s.dt_s);
    double mean_V = pending.acting_V(), before_V = mean_V;
    std::size_t applied_changes = 0;
    for (std::size_t n = 0; n < pending.count(); ++n) {
      const double fraction = std::clamp((pending.age_s(n) - delay_s) / s.dt_s, 0.0, 1.0);
      if (fraction > 0) mean_V += fraction * (pending.volts(n) - before_V);
      before_V = pending.volts(n);
      applied_changes += fraction == 1;
    }
    while (applied_changes-- > 0) pending.apply_oldest();
    return mean_V;
  }

 private:
  /// Pending voltage changes, the oldest first, with their age at the end of a step.
  class Pending {
   public:
    static constexpr std::size_t max_pending = 3;

    explicit Pending(Memory& memory) : memory_(memory) {}
    bool started() const { return memory_[1] > 0; }
    void start(double volts) { memory_[0] = volts, memory_[1] = 1; }
    std::size_t count() const { return static_cast<std::size_t>(memory_[1]) - 1; }
    double acting_V() const { return memory_[0]; }
    double& volts(std::size_t n) { return memory_[2 + 2 * n]; }
    double& age_s(std::size_t n) { return memory_[3 + 2 * n]; }
    double newest_V() { return count() > 0 ? volts(count() - 1) : memory_[0]; }
    void add(double volts_V, double age) {
      if (count() == max_pending) apply_oldest();
      volts(count()) = volts_V, age_s(count()) = age, memory_[1] += 1;
    }
    /// Makes the oldest change the acting voltage.
    void apply_oldest() {
      memory_[0] = memory_[2], memory_[1] -= 1;
      std::ranges::copy(std::span(memory_).subspan(4, 2 * (max_pending - 1)), memory_.begin() + 2);
    }

   private:
    Memory& memory_;  // acting voltage, 1 + count, then voltage and age of each change
  };
};

}  // namespace sim::effects
