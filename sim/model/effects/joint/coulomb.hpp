#pragma once
#include <algorithm>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Change of the dry friction of a joint.
///
///   τ_C' = max(0, τ_C + a)
///
/// Source: Coulomb 1785.
struct JointCoulomb {
  static constexpr About about{"joint_coulomb", Stage::joint, Seat::joint,
                               "slow motion in both directions"};

  double extra_Nm = 0;  // a

  void visit(auto& v) { v("extra_Nm", extra_Nm, Bounds{-1, 5}); }
  void change_joint(auto& joint) const {
    joint.coulomb_Nm = std::max(0.0, joint.coulomb_Nm + extra_Nm);
  }
};

}  // namespace sim::effects
