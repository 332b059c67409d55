#pragma once
#include <algorithm>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Change of the tendon's damping.
///
///   D' = max(0, D + a)
///
/// Source: paper, eq. 1.
struct TendonDamping {
  static constexpr About about{"tendon_damping", Stage::tendon, Seat::actuator,
                               "fast changes of tension"};

  double extra_N_s_per_m = 0;  // a

  void visit(auto& v) { v("extra_N_s_per_m", extra_N_s_per_m, Bounds{-1000, 3000}); }
  void change_actuator(auto& actuator) const {
    actuator.tendon.damping_N_s_per_m =
        std::max(0.0, actuator.tendon.damping_N_s_per_m + extra_N_s_per_m);
  }
};

}  // namespace sim::effects
