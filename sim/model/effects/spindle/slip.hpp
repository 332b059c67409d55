#pragma once
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// The line creeps on the spindle as it is wound and unwound under load, which permanently changes
/// its free length.
///
///   dl = s F |dw|,   w the line length on the spindle;   L_K' = L_K + l
///
/// Source: chosen, after the creep of belts (Johnson, Contact Mechanics, 1985, ch. 8).
struct SpindleSlip {
  static constexpr About about{"spindle_slip", Stage::spindle, Seat::actuator,
                               "repeated winding and unwinding under load"};

  double per_N = 0;  // s

  void visit(auto& v) { v("per_N", per_N, Bounds{0, 0.001}); }
  Sloped wound(const ChainSample& s, Sloped line, Memory& memory) const {
    double &slipped_m = memory[0], &previous_m = memory[1], &initialized = memory[2];
    if (initialized == 0) previous_m = line.value, initialized = 1;
    slipped_m += per_N * s.tension_N * std::abs(line.value - previous_m);
    previous_m = line.value;
    return {line.value - slipped_m, line.slope};
  }
};

}  // namespace sim::effects
