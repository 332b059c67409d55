#pragma once
#include <algorithm>
#include <cmath>

#include "sim/effects/effect.hpp"

namespace sim::effects {

/// Play between the gearbox, where the angle is measured, and the spindle.
///
///   θ_s = θ + g,   0 ≤ g ≤ b;   a load holds the spindle against one flank:  r F > τ₀  ⇒  g = 0
///                               else it stays where it is while the gear crosses the play
///
/// A tendon only pulls: the play is crossed where it goes nearly slack. The spindle has no mass,
/// its own friction is τ₀. Source: Nordin, Gutman, Automatica 38, 2002 (play with a light load
/// side).
struct GearboxBacklash {
  static constexpr About about{"gearbox_backlash", Stage::gearbox, Seat::actuator,
                               "reversals through slack"};

  double width_rad = 0;                // b, of the gearbox shaft
  double spindle_friction_Nm = 0.005;  // τ₀

  void visit(auto& v) {
    v("width_rad", width_rad, Bounds{0, 0.5});
    v.shape("spindle_friction_Nm", spindle_friction_Nm, Bounds{0, 1});
  }
  Sloped wound(const ChainSample& s, Sloped line, Memory& memory) const {
    double &gap_rad = memory[0], &last_rad = memory[1];
    const bool held = s.load_Nm > spindle_friction_Nm;
    gap_rad = held ? 0 : std::clamp(gap_rad - (s.shaft_rad - last_rad), 0.0, width_rad);
    last_rad = s.shaft_rad;
    const bool crossing = !held && gap_rad > 0 && gap_rad < width_rad;
    return {line.value + line.slope * gap_rad, crossing ? 0 : line.slope};
  }
};

}  // namespace sim::effects
