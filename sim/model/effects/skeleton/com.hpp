#pragma once
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// A body's centre of mass is shifted by d, away from its joint.
///
///   c' = c + d c/|c|
///
/// Source: CAD models omit cables, screws and glue.
struct SkeletonCom {
  static constexpr About about{"skeleton_com", Stage::skeleton, Seat::body,
                               "static postures and fast motion"};

  double outwards_m = 0;  // d

  void visit(auto& v) { v("outwards_m", outwards_m, Bounds{-0.3, 0.3}); }
  void change_body(auto& body) const {
    auto& [x, y, z] = body.com_m;
    const double com_distance_m = std::hypot(x, y, z);
    if (com_distance_m == 0) return;
    for (double* c : {&x, &y, &z}) *c *= 1 + outwards_m / com_distance_m;
  }
};

}  // namespace sim::effects
