#pragma once
#include <algorithm>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Change of the viscous friction of a joint.
///
///   µ' = max(0, µ + a)
///
/// Source: Stokes 1851, for lubricated bearings.
struct JointViscous {
  static constexpr About about{"joint_viscous", Stage::joint, Seat::joint, "several speeds"};

  double extra_Nm_s_per_rad = 0;  // a

  void visit(auto& v) { v("extra_Nm_s_per_rad", extra_Nm_s_per_rad, Bounds{-1, 5}); }
  void change_joint(auto& joint) const {
    joint.viscous_Nm_s_per_rad = std::max(0.0, joint.viscous_Nm_s_per_rad + extra_Nm_s_per_rad);
  }
};

}  // namespace sim::effects
