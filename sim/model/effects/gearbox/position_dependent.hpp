#pragma once
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Dry friction that depends on the shaft angle, caused by a worn tooth or a tilted bearing.
///
///   τ_CG' = max(0, τ_CG + a sin n θ + b cos n θ)          θ: angle of the gearbox shaft
///
/// Source: Armstrong-Hélouvry 1991, ch. 4 (position-dependent friction of gears).
struct GearboxPositionDependent {
  static constexpr About about{"gearbox_position_dependent", Stage::gearbox, Seat::actuator,
                               "slow turning in both directions over a full turn of the gearbox"};

  double sine_Nm = 0, cosine_Nm = 0;  // a, b
  double periods_per_turn = 1;        // n, of the gearbox shaft

  void visit(auto& v) {
    v("sine_Nm", sine_Nm, Bounds{-10, 10});
    v("cosine_Nm", cosine_Nm, Bounds{-10, 10});
    v.shape("periods_per_turn", periods_per_turn, Bounds{1, 100});
  }
  double friction_Nm(int, const ChainSample& s) const {
    const double phase = periods_per_turn * s.shaft_rad;
    return sine_Nm * std::sin(phase) + cosine_Nm * std::cos(phase);
  }
};

}  // namespace sim::effects
