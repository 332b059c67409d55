#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// A body's mass is spread otherwise about its centre.
///
///   I' = (1 + a) I
///
/// Source: CAD leaves out cables, screws and glue.
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
