#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// The joint's stops are inside the nominal range.
///
///   min' = min + a,   max' = max − b
///
/// Source: manufacturing tolerance of printed joints.
struct JointEarlyStop {
  static constexpr About about{"joint_early_stop", Stage::joint, Seat::joint,
                               "the whole range of the joint, into its stops"};

  double from_min_rad = 0, from_max_rad = 0;  // a, b

  void visit(auto& v) {
    v("from_min_rad", from_min_rad, Bounds{0, 1.5});
    v("from_max_rad", from_max_rad, Bounds{0, 1.5});
  }
  void change_joint(auto& joint) const {
    joint.min_rad += from_min_rad, joint.max_rad -= from_max_rad;
  }
};

}  // namespace sim::effects
