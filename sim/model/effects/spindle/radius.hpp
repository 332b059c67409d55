#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Change of the spindle radius.
///
///   r' = (1 + a) r
///
/// Source: paper, eq. 2.
struct SpindleRadius {
  static constexpr About about{"spindle_radius", Stage::spindle, Seat::actuator,
                               "winding and unwinding over a long line length"};

  double relative = 0;  // a

  void visit(auto& v) { v("relative", relative, Bounds{-0.5, 1}); }
  void change_actuator(auto& actuator) const { actuator.spindle.radius_m *= 1 + relative; }
};

}  // namespace sim::effects
