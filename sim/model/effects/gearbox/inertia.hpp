#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Change of the inertia of the rotor and the parts that turn with it.
///
///   J_M' = (1 + a) J_M
///
/// Source: paper, eq. 3.
struct GearboxInertia {
  static constexpr About about{"gearbox_inertia", Stage::gearbox, Seat::actuator,
                               "fast reversals under a small load"};

  double relative = 0;  // a

  void visit(auto& v) { v("relative", relative, Bounds{-0.8, 4}); }
  void change_motor(auto& motor) const { motor.rotor_inertia_kg_m2 *= 1 + relative; }
};

}  // namespace sim::effects
