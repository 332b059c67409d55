#pragma once
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// The line lies on itself: the radius grows with what is wound up.
///
///   r(θ) = r + g θ,   L_K = L_K0 − r θ − g θ²/2
///
/// Smoothly, not layer by layer. Below a fifth of r it stays there.
/// Source: ours; the radius of Archimedes’ spiral.
struct SpindleLayers {
  static constexpr About about{"spindle_layers", Stage::spindle, Seat::actuator,
                               "much line wound up and let out"};

  double growth_m_per_rad = 0;  // g

  void visit(auto& v) { v("growth_m_per_rad", growth_m_per_rad, Bounds{-0.001, 0.001}); }
  Sloped wound(const ChainSample& s, Sloped line, Memory&) const {
    const double least = -0.8 * s.radius_m, grown = growth_m_per_rad * s.shaft_rad;
    if (grown >= least) return {line.value + grown * s.shaft_rad / 2, line.slope + grown};
    const double edge_rad = least / growth_m_per_rad;
    return {line.value + least * (s.shaft_rad - edge_rad / 2), line.slope + least};
  }
};

}  // namespace sim::effects
