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
    constexpr double max_shrinkage = 0.8;  // chosen
    const double min_growth_m = -max_shrinkage * s.radius_m,
                 growth_m = growth_m_per_rad * s.shaft_rad;
    if (growth_m >= min_growth_m)
      return {line.value + growth_m * s.shaft_rad / 2, line.slope + growth_m};
    const double edge_rad = min_growth_m / growth_m_per_rad;
    return {line.value + min_growth_m * (s.shaft_rad - edge_rad / 2), line.slope + min_growth_m};
  }
};

}  // namespace sim::effects
