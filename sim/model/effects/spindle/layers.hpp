#pragma once
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// The line is wound in layers: the radius grows with the wound length.
///
///   r(θ) = r + g θ,   L_K = L_K0 − r θ − g θ²/2
///
/// The growth is continuous, not layer by layer. The radius does not fall below r/5.
/// Source: chosen; the radius of an Archimedean spiral.
struct SpindleLayers {
  static constexpr About about{"spindle_layers", Stage::spindle, Seat::actuator,
                               "winding and unwinding over a long line length"};

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
