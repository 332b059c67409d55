#pragma once
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Dry friction of teeth and bearings that increases with their load.
///
///   τ_CG' = τ_CG + µ |r F|
///
/// Source: Hamon et al., dry friction depending on load and velocity, ISR 2010.
struct GearboxLoadDependent {
  static constexpr About about{"gearbox_load_dependent", Stage::gearbox, Seat::actuator,
                               "motion in both directions under several loads"};

  double share = 0;  // µ

  void visit(auto& v) { v("share", share, Bounds{0, 0.9}); }
  double friction_Nm(int, const ChainSample& s) const { return share * std::abs(s.load_Nm); }
};

}  // namespace sim::effects
