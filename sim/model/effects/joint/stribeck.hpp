#pragma once
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Dry friction in a joint that is greater near rest.
///
///   τ_C' = τ_C + a exp(−(ω/ω_s)²)
///
/// A smaller ω_s than allowed is not told from sticking, which leaves a resting joint any torque.
/// Source: Stribeck 1902; Armstrong-Hélouvry 1991.
struct JointStribeck {
  static constexpr About about{"joint_stribeck", Stage::joint, Seat::joint,
                               "slow reversals, down to standing still"};

  double extra_Nm = 0;           // a
  double speed_rad_per_s = 0.2;  // ω_s

  void visit(auto& v) {
    v("extra_Nm", extra_Nm, Bounds{0, 5});
    v("speed_rad_per_s", speed_rad_per_s, Bounds{0.05, 3});
  }
  double joint_friction_Nm(double speed) const {
    const double x = speed / speed_rad_per_s;
    return extra_Nm * std::exp(-x * x);
  }
};

}  // namespace sim::effects
