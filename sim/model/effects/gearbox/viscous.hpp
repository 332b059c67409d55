#pragma once
#include <algorithm>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Change of the viscous friction, for example by stiff grease.
///
///   µ_G' = max(0, µ_G + a)
///
/// Source: paper, eq. 3.
struct GearboxViscous {
  static constexpr About about{"gearbox_viscous", Stage::gearbox, Seat::actuator,
                               "several speeds under one load"};

  double extra_Nm_s_per_rad = 0;  // a

  void visit(auto& v) { v("extra_Nm_s_per_rad", extra_Nm_s_per_rad, Bounds{-1, 10}); }
  void change_motor(auto& motor) const {
    motor.gear_viscous_Nm_s_per_rad =
        std::max(0.0, motor.gear_viscous_Nm_s_per_rad + extra_Nm_s_per_rad);
  }
};

}  // namespace sim::effects
