#pragma once
#include <cmath>

#include "sim/model/effects/drawn.hpp"

namespace sim::effects {

/// The braid's fibres rub: the pull lags behind the stretch however slow it is.
///
///   F = f(x) + F_h z,   dz = (dx/x_h) (1 − [z dx > 0] |z|)
///
/// x: as far as it is drawn out. Bouc–Wen with n = 1, β = γ; exact for a step dx.
/// Source: Bouc 1967; Wen, J. Eng. Mech. 102, 1976.
struct TendonHysteresis {
  static constexpr About about{"tendon_hysteresis", Stage::tendon, Seat::actuator,
                               "slow stretching and letting go, by several amounts"};

  double force_N = 0;     // F_h
  double width_m = 5e-4;  // x_h

  void visit(auto& v) {
    v("force_N", force_N, Bounds{0, 50});
    v("width_m", width_m, Bounds{2e-5, 0.01});
  }
  Sloped pull(const ChainSample& s, Memory& memory) const {
    double &z = memory[0], &last_m = memory[1], &began = memory[2];
    const double x_m = drawn_m(s);
    if (began == 0) last_m = x_m, began = 1;
    double left = (x_m - last_m) / width_m;
    last_m = x_m;
    if (z * left < 0) {  // relaxing, as far as z = 0
      const double relaxed = std::copysign(std::fmin(std::abs(left), std::abs(z)), left);
      z += relaxed, left -= relaxed;
    }
    if (left != 0) {
      const double way = std::copysign(1.0, left);
      z = way - (way - z) * std::exp(-std::abs(left));
    }
    return {force_N * z, force_N / width_m * (1 - std::abs(z))};
  }
};

}  // namespace sim::effects
