#pragma once
#include "sim/model/effects/effect.hpp"
#include "sim/model/effects/softer_line.hpp"

namespace sim::effects {

/// Torsional compliance of the shaft between the gearbox, where the angle is measured, and the
/// spindle.
///
///   θ_s = θ − c r F,   equivalent to an additional line compliance  r² c
///
/// Equivalent to an elastic line and, for a linear spring, nearly equivalent to a softer spring.
/// Source: Spong, J. Dyn. Sys. Meas. Control 109, 1987.
struct GearboxShaftCompliance {
  static constexpr About about{"gearbox_shaft_compliance", Stage::gearbox, Seat::actuator,
                               "several tensions at several stretches"};

  double rad_per_Nm = 0;  // c

  void visit(auto& v) { v("rad_per_Nm", rad_per_Nm, Bounds{0, 20}); }
  void change_actuator(auto& actuator) const {
    const double r = actuator.spindle.radius_m;
    soften_line(actuator.tendon, r * r * rad_per_Nm);
  }
};

}  // namespace sim::effects
