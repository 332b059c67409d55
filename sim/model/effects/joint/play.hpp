#pragma once
#include <algorithm>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Play between the shaft of the joint's sensor and the bone.
///
///   |q_shaft − q| ≤ b/2, otherwise the bone moves the shaft
///
/// Source: play operator, Krasnosel'skii, Pokrovskii, Systems with Hysteresis, 1989.
struct JointPlay {
  static constexpr About about{"joint_play", Stage::joint, Seat::joint, "reversals"};

  double width_rad = 0;  // b

  void visit(auto& v) { v("width_rad", width_rad, Bounds{0, 0.3}); }
  double sensor_shaft_rad(double angle_rad, Memory& memory) const {
    double& shaft_rad = memory[0];
    return shaft_rad = std::clamp(shaft_rad, angle_rad - width_rad / 2, angle_rad + width_rad / 2);
  }
  double play_rad() const { return width_rad; }
};

}  // namespace sim::effects
