#pragma once
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// An additional point mass on a body, on the line from its joint through its centre of mass.
///
///   m' = m + m_p,  c' = (m c + m_p p)/m',  I' about c' by the parallel axis theorem;  p = d c/|c|
///
/// Source: paper, Fig. 7b (a grasped mass).
struct SkeletonPayload {
  static constexpr About about{"skeleton_payload", Stage::skeleton, Seat::body,
                               "static postures and fast motion"};

  double mass_kg = 0;        // m_p
  double distance_m = 0.25;  // d

  void visit(auto& v) {
    v("mass_kg", mass_kg, Bounds{0, 10});
    v.shape("distance_m", distance_m, Bounds{0, 2});
  }
  void change_body(auto& body) const {
    auto& c = body.com_m;
    const double com_distance_m = std::hypot(c[0], c[1], c[2]);
    if (com_distance_m == 0 || body.mass_kg + mass_kg == 0) return;
    const double reduced_mass_kg = body.mass_kg * mass_kg / (body.mass_kg + mass_kg);
    const double mass_fraction = mass_kg / (body.mass_kg + mass_kg);
    double s[3];  // m, from the old centre of mass to the payload
    for (std::size_t i = 0; i < 3; ++i) s[i] = c[i] * (distance_m / com_distance_m - 1);
    const double distance2_m2 = s[0] * s[0] + s[1] * s[1] + s[2] * s[2];
    for (std::size_t i = 0; i < 3; ++i) {
      body.inertia_kg_m2[i] += reduced_mass_kg * (distance2_m2 - s[i] * s[i]);
      c[i] += mass_fraction * s[i];
    }
    body.products_kg_m2[0] -= reduced_mass_kg * s[0] * s[1];
    body.products_kg_m2[1] -= reduced_mass_kg * s[0] * s[2];
    body.products_kg_m2[2] -= reduced_mass_kg * s[1] * s[2];
    body.mass_kg += mass_kg;
  }
};

}  // namespace sim::effects
