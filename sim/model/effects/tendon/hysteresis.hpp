#pragma once
#include <cmath>

#include "sim/model/effects/taut_stretch.hpp"

namespace sim::effects {

/// Friction between the fibres of the braid: rate-independent hysteresis of tension over stretch.
///
///   F = f(x) + F_h z,   dz = (dx/x_h) (1 − [z dx > 0] |z|)
///
/// x: stretch, 0 if slack. Bouc–Wen with n = 1, β = γ; exact for a step dx.
/// Source: Bouc 1967; Wen, J. Eng. Mech. 102, 1976.
struct TendonHysteresis {
  static constexpr About about{"tendon_hysteresis", Stage::tendon, Seat::actuator,
                               "slow loading and unloading with several amplitudes"};

  double force_N = 0;     // F_h
  double width_m = 5e-4;  // x_h

  void visit(auto& v) {
    v("force_N", force_N, Bounds{0, 50});
    v("width_m", width_m, Bounds{2e-5, 0.01});
  }
  Sloped pull(const ChainSample& s, Memory& memory) const {
    double &z = memory[0], &previous_m = memory[1], &initialized = memory[2];
    const double x_m = taut_stretch_m(s);
    if (initialized == 0) previous_m = x_m, initialized = 1;
    double remaining = (x_m - previous_m) / width_m;
    previous_m = x_m;
    if (z * remaining < 0) {  // unloading until z = 0
      const double unloading =
          std::copysign(std::fmin(std::abs(remaining), std::abs(z)), remaining);
      z += unloading, remaining -= unloading;
    }
    if (remaining != 0) {
      const double direction = std::copysign(1.0, remaining);
      z = direction - (direction - z) * std::exp(-std::abs(remaining));
    }
    return {force_N * z, force_N / width_m * (1 - std::abs(z))};
  }
};

}  // namespace sim::effects
