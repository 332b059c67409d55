#pragma once
#include <cmath>
#include <variant>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// The attachment of the tendon's distal end is shifted by d, away from the bone's joint.
///
///   p' = p (1 + d / |p|)
///
/// Source: paper, 4.4 (attachment points are calibrated).
struct RoutingAttachmentShift {
  static constexpr About about{"routing_attachment_shift", Stage::routing, Seat::actuator,
                               "the whole range of the joint"};

  double outwards_m = 0;  // d

  void visit(auto& v) { v("outwards_m", outwards_m, Bounds{-0.05, 0.05}); }
  void change_actuator(auto& actuator) const {
    const auto shift = [this](auto& end) {
      if constexpr (requires { end.at_m; }) {
        auto& [x, y, z] = end.at_m;
        const double distance_from_origin_m = std::hypot(x, y, z);
        if (distance_from_origin_m == 0) return;
        for (double* c : {&x, &y, &z}) *c *= 1 + outwards_m / distance_from_origin_m;
      }
    };
    if (!actuator.tendon.path.empty()) std::visit(shift, actuator.tendon.path.back());
  }
};

}  // namespace sim::effects
