#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Change of the spring's stiffness.
///
///   κ' = (1 + a) κ,   κ₃' = (1 + a) κ₃
///
/// Source: paper, eq. 1.
struct TendonStiffness {
  static constexpr About about{"tendon_stiffness", Stage::tendon, Seat::actuator,
                               "several tensions at several stretches"};

  double relative = 0;  // a

  void visit(auto& v) { v("relative", relative, Bounds{-0.8, 3}); }
  void change_actuator(auto& actuator) const {
    actuator.tendon.stiffness_N_per_m *= 1 + relative;
    actuator.tendon.cubic_N_per_m3 *= 1 + relative;
  }
};

}  // namespace sim::effects
