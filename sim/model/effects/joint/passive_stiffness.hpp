#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// A spring torque on a joint, caused by cables, covers or ligaments.
///
///   τ = −k (q − q₀)
///
/// Source: Hatze 1997 for human joints; here linear.
struct JointPassiveStiffness {
  static constexpr About about{"joint_passive_stiffness", Stage::joint, Seat::joint,
                               "the whole range of the joint, slowly"};

  double stiffness_Nm_per_rad = 0;  // k
  double rest_rad = 0;              // q₀

  void visit(auto& v) {
    v("stiffness_Nm_per_rad", stiffness_Nm_per_rad, Bounds{0, 1000});
    v("rest_rad", rest_rad, Bounds{-3.2, 3.2});
  }
  Sloped joint_torque(double angle_rad) const {
    return {-stiffness_Nm_per_rad * (angle_rad - rest_rad), -stiffness_Nm_per_rad};
  }
};

}  // namespace sim::effects
