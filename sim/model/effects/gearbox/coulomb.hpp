#pragma once
#include <algorithm>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Change of the dry friction.
///
///   τ_CG' = max(0, τ_CG + a)
///
/// Source: Coulomb 1785; paper, eq. 3.
struct GearboxCoulomb {
  static constexpr About about{"gearbox_coulomb", Stage::gearbox, Seat::actuator,
                               "slow motion in both directions under a constant load"};

  double extra_Nm = 0;  // a

  void visit(auto& v) { v("extra_Nm", extra_Nm, Bounds{-1, 10}); }
  void change_motor(auto& motor) const {
    motor.gear_coulomb_Nm = std::max(0.0, motor.gear_coulomb_Nm + extra_Nm);
  }
};

}  // namespace sim::effects
