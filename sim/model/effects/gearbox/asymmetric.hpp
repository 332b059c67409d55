#pragma once
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Dry and viscous friction that is greater in one direction.
///
///   τ_CG⁺ = τ_CG + a + b |ω| winding up,   τ_CG⁻ = τ_CG − a − b |ω| unwinding
///
/// Source: Armstrong-Hélouvry, Dupont, Canudas de Wit, Automatica 30, 1994.
struct GearboxAsymmetric {
  static constexpr About about{"gearbox_asymmetric", Stage::gearbox, Seat::actuator,
                               "slow motion in both directions under a constant load"};

  double extra_Nm = 0;            // a
  double extra_Nm_s_per_rad = 0;  // b

  void visit(auto& v) {
    v("extra_Nm", extra_Nm, Bounds{-5, 5});
    v("extra_Nm_s_per_rad", extra_Nm_s_per_rad, Bounds{-1, 1});
  }
  double friction_Nm(int direction, const ChainSample& s) const {
    return direction * (extra_Nm + extra_Nm_s_per_rad * std::abs(s.speed_rad_per_s));
  }
};

}  // namespace sim::effects
