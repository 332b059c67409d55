#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// A random delay of each command.
///
///   t_received = t_sent + T u,   u uniform in 0 … 1
///
/// Source: Nilsson, Real-Time Control Systems with Delays, Lund 1998.
struct Jitter {
  static constexpr About about{"bus_jitter", Stage::bus, Seat::robot,
                               "fast changes of the references"};

  double spread_s = 0;  // T

  void visit(auto& v) { v("spread_s", spread_s, Bounds{0, 0.1}); }
  double command_delay_s(double uniform) const { return spread_s * uniform; }
};

}  // namespace sim::effects
