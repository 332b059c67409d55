#pragma once
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Additional dry friction of a joint near zero speed.
///
///   τ_C' = τ_C + a exp(−(ω/ω_s)²)
///
/// An ω_s below the bound cannot be distinguished from sticking, where the torque is undetermined.
/// Source: Stribeck 1902; Armstrong-Hélouvry 1991.
struct JointStribeck {
  static constexpr About about{"joint_stribeck", Stage::joint, Seat::joint,
                               "slow reversals, down to standstill"};

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
