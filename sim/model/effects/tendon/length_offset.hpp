#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// The line is too short (l > 0) or too long: equivalent to a path that is longer by l.
///
///   Δx' = Δx + l
///
/// Source: paper, eq. 2, L_K0.
struct TendonLengthOffset {
  static constexpr About about{"tendon_length_offset", Stage::tendon, Seat::actuator,
                               "any tension at known angles"};

  double length_m = 0;  // l

  void visit(auto& v) { v("length_m", length_m, Bounds{-0.05, 0.05}); }
  Sloped path(const ChainSample&, Sloped path) const { return {path.value + length_m, path.slope}; }
};

}  // namespace sim::effects
