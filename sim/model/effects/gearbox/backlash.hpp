#pragma once
#include <algorithm>
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Play between the gearbox, where the angle is measured, and the spindle.
///
///   θ_s = θ + g,   0 ≤ g ≤ b        g = 0: the gear holds the line
///
/// A tendon only pulls. Where it goes nearly slack the gear leaves the spindle, which its own
/// friction τ₀ holds; a line that pulls more, r F > τ₀, draws it along until the gear is met again:
///
///   g ← g − Δθ  within 0 … b,   then as much less as brings r κ Δx(θ + g) down to τ₀
///
/// A shaft in place of a line pushes too: below −τ₀ it draws the spindle to the gear's other flank;
/// its angles are 0 in the middle of the play, θ_s = θ + g − b/2.
/// The spindle has no mass. Source: Nordin, Gutman, Automatica 38, 2002 (play with a light load
/// side).
struct GearboxBacklash {
  static constexpr About about{"gearbox_backlash", Stage::gearbox, Seat::actuator,
                               "reversals through slack"};

  double width_rad = 0;                // b, of the gearbox shaft
  double spindle_friction_Nm = 0.003;  // τ₀

  void visit(auto& v) {
    v("width_rad", width_rad, Bounds{0, 0.5});
    v("spindle_friction_Nm", spindle_friction_Nm, Bounds{2e-4, 0.1});
  }
  Sloped wound(const ChainSample& s, Sloped line, Memory& memory) const {
    double &gap_rad = memory[0], &last_rad = memory[1];
    gap_rad = std::clamp(gap_rad - (s.shaft_rad - last_rad), 0.0, width_rad);
    last_rad = s.shaft_rad;
    const double held_m = spindle_friction_Nm / (s.radius_m * s.stiffness_N_per_m);
    const double middle_rad = s.pushes ? width_rad / 2 : 0;
    const double stretch_m = s.stretch_m - s.radius_m * middle_rad;
    gap_rad = std::min(gap_rad, std::max(0.0, (held_m - stretch_m) / s.radius_m));
    if (s.pushes)
      gap_rad = std::max(gap_rad, std::min(width_rad, (-held_m - stretch_m) / s.radius_m));
    const bool crossing = gap_rad > 0 && gap_rad < width_rad;
    return {line.value + line.slope * (gap_rad - middle_rad), crossing ? 0 : line.slope};
  }
};

}  // namespace sim::effects
