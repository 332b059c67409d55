#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Change of the tendon's moment arms and of their dependence on posture.
///
///   l' = l + a l + c l²/2,   l = L − L₀          ∂L'/∂q = (1 + a + c l) ∂L/∂q
///
/// Source: Pandy, moment arms from length over angle, Exerc. Sport Sci. Rev. 27, 1999; the form is
/// chosen.
struct RoutingMomentArm {
  static constexpr About about{"routing_moment_arm", Stage::routing, Seat::actuator,
                               "the whole range of the joint"};

  double relative = 0;        // a
  double relative_per_m = 0;  // c

  void visit(auto& v) {
    v("relative", relative, Bounds{-0.6, 1});
    v("relative_per_m", relative_per_m, Bounds{-30, 30});
  }
  Sloped path(const ChainSample& s, Sloped path) const {
    const double l = s.path_change_m;
    return {path.value + relative * l + relative_per_m * l * l / 2,
            path.slope + relative + relative_per_m * l};
  }
};

}  // namespace sim::effects
