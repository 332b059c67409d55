#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// The spring stiffens with stretch.
///
///   F = κ x + (κ₃ + a) x³
///
/// Source: Potkonjak et al., puller-follower control of compliant antagonists, 2011.
struct TendonStiffening {
  static constexpr About about{"tendon_stiffening", Stage::tendon, Seat::actuator,
                               "tensions from low to high"};

  double cubic_N_per_m3 = 0;  // a

  void visit(auto& v) { v("cubic_N_per_m3", cubic_N_per_m3, Bounds{0, 1e10}); }
  void change_actuator(auto& actuator) const { actuator.tendon.cubic_N_per_m3 += cubic_N_per_m3; }
};

}  // namespace sim::effects
