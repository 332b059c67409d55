#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Change of a body's mass, with the same mass distribution.
///
///   m' = (1 + a) m,   I' = (1 + a) I
///
/// Source: printed parts are not solid; CAD models omit cables and screws.
struct SkeletonMass {
  static constexpr About about{"skeleton_mass", Stage::skeleton, Seat::body,
                               "static postures and fast motion"};

  double relative = 0;  // a

  void visit(auto& v) { v("relative", relative, Bounds{-0.8, 3}); }
  void change_body(auto& body) const {
    body.mass_kg *= 1 + relative;
    for (auto* set : {&body.inertia_kg_m2, &body.products_kg_m2})
      for (double& i : *set) i *= 1 + relative;
  }
};

}  // namespace sim::effects
