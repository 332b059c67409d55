#pragma once
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Additional dry friction near zero speed, which decreases as the lubricant film builds up.
///
///   τ_CG' = τ_CG + a exp(−(ω/ω_s)²)
///
/// Source: Stribeck 1902; Armstrong-Hélouvry 1991.
struct GearboxStribeck {
  static constexpr About about{"gearbox_stribeck", Stage::gearbox, Seat::actuator,
                               "slow reversals, down to standstill"};

  double extra_Nm = 0;           // a
  double speed_rad_per_s = 0.3;  // ω_s

  void visit(auto& v) {
    v("extra_Nm", extra_Nm, Bounds{0, 10});
    v("speed_rad_per_s", speed_rad_per_s, Bounds{0.02, 3});
  }
  double friction_Nm(int, const ChainSample& s) const {
    const double x = s.speed_rad_per_s / speed_rad_per_s;
    return extra_Nm * std::exp(-x * x);
  }
};

}  // namespace sim::effects
