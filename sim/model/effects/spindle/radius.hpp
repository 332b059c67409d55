#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// The spindle is thicker or thinner.
///
///   r' = (1 + a) r
///
/// Source: paper, eq. 2.
struct SpindleRadius {
  static constexpr About about{"spindle_radius", Stage::spindle, Seat::actuator,
                               "much line wound up and let out"};

  double relative = 0;  // a

  void visit(auto& v) { v("relative", relative, Bounds{-0.5, 1}); }
  void change_actuator(auto& actuator) const { actuator.spindle.radius_m *= 1 + relative; }
};

}  // namespace sim::effects
