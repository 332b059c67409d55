#pragma once
#include "sim/effects/effect.hpp"

namespace sim::effects {

/// Dry friction that is greater in one direction.
///
///   τ_CG⁺ = τ_CG + a winding up,   τ_CG⁻ = τ_CG − a unwinding
///
/// Source: Armstrong-Hélouvry, Dupont, Canudas de Wit, Automatica 30, 1994.
struct GearboxAsymmetric {
  static constexpr About about{"gearbox_asymmetric", Stage::gearbox, Seat::actuator,
                               "slow motion both ways under a steady load"};

  double extra_Nm = 0;  // a

  void visit(auto& v) { v("extra_Nm", extra_Nm, Bounds{-5, 5}); }
  double friction_Nm(int direction, const ChainSample&) const { return direction * extra_Nm; }
};

}  // namespace sim::effects
