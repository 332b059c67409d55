#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Change of a body's inertia about its centre of mass.
///
///   I' = (1 + a) I
///
/// Source: CAD models omit cables, screws and glue.
struct SkeletonInertia {
  static constexpr About about{"skeleton_inertia", Stage::skeleton, Seat::body, "fast reversals"};

  double relative = 0;  // a

  void visit(auto& v) { v("relative", relative, Bounds{-0.9, 5}); }
  void change_body(auto& body) const {
    for (auto* set : {&body.inertia_kg_m2, &body.products_kg_m2})
      for (double& i : *set) i *= 1 + relative;
  }
};

}  // namespace sim::effects
