#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Commands arrive later.
///
///   t_heard = t_sent + T
///
/// One delay of all sensors looks the same unless both ends stamp time.
/// Source: Nilsson, Real-Time Control Systems with Delays, Lund 1998.
struct CommandDelay {
  static constexpr About about{"bus_command_delay", Stage::bus, Seat::robot,
                               "references that change fast"};

  double delay_s = 0;  // T

  void visit(auto& v) { v("delay_s", delay_s, Bounds{0, 0.1}); }
  double command_delay_s(double) const { return delay_s; }
};

}  // namespace sim::effects
