#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// A constant delay of the commands.
///
///   t_received = t_sent + T
///
/// An equal delay of all sensors cannot be distinguished from it unless both ends timestamp.
/// Source: Nilsson, Real-Time Control Systems with Delays, Lund 1998.
struct CommandDelay {
  static constexpr About about{"bus_command_delay", Stage::bus, Seat::robot,
                               "fast changes of the references"};

  double delay_s = 0;  // T

  void visit(auto& v) { v("delay_s", delay_s, Bounds{0, 0.1}); }
  double command_delay_s(double) const { return delay_s; }
};

}  // namespace sim::effects
