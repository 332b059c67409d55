#pragma once
#include <algorithm>
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Backlash between the gearbox, where the angle is measured, and the spindle.
///
///   θ_s = θ + g,   0 ≤ g ≤ b        g = 0: the gear carries the line
///
/// A tendon only pulls. When it is nearly slack, the gear separates from the spindle, which its own
/// friction τ₀ holds in place. A line with r F > τ₀ turns the spindle until it contacts the gear:
///
///   g ← g − Δθ  within 0 … b,   then reduced until r κ Δx(θ + g) falls to τ₀
///
/// A shaft instead of a line also pushes: below −τ₀ it turns the spindle to the gear's other flank.
/// Its angles are 0 in the middle of the backlash, θ_s = θ + g − b/2.
/// Ignores the mass of the spindle. Source: Nordin, Gutman, Automatica 38, 2002 (backlash with a
/// light load side).
struct GearboxBacklash {
  static constexpr About about{"gearbox_backlash", Stage::gearbox, Seat::actuator,
                               "reversals through the slack state"};

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
    const double friction_stretch_m = spindle_friction_Nm / (s.radius_m * s.stiffness_N_per_m);
    const double middle_rad = s.pushes ? width_rad / 2 : 0;
    const double stretch_m = s.stretch_m - s.radius_m * middle_rad;
    gap_rad = std::min(gap_rad, std::max(0.0, (friction_stretch_m - stretch_m) / s.radius_m));
    if (s.pushes)
      gap_rad =
          std::max(gap_rad, std::min(width_rad, (-friction_stretch_m - stretch_m) / s.radius_m));
    const bool crossing = gap_rad > 0 && gap_rad < width_rad;
    return {line.value + line.slope * (gap_rad - middle_rad), crossing ? 0 : line.slope};
  }
};

}  // namespace sim::effects
