#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// How far a tendon is drawn out, m: one whose line hangs slack not at all, however far its ends have
/// come together. A shaft, which pushes as well, is compressed.
inline double drawn_m(const ChainSample& s) {
  return s.pushes || s.stretch_m > 0 ? s.stretch_m : 0.0;
}

}  // namespace sim::effects
