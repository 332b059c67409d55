#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Stretch of a tendon, m; 0 if the line is slack. A shaft also transmits compression, so its stretch
/// may be negative.
inline double taut_stretch_m(const ChainSample& s) {
  return s.pushes || s.stretch_m > 0 ? s.stretch_m : 0.0;
}

}  // namespace sim::effects
