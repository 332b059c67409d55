#pragma once
#include <cmath>

#include "sim/model/effects/drawn.hpp"

namespace sim::effects {

/// Held at one stretch the tendon's pull decays towards the spring's: a Zener body.
///
///   F = f(x) + κ₁ (x − y),   dy/dt = (x − y) / T
///
/// x: as far as it is drawn out. y starts at the first x: the tendon has rested.
/// Source: Zener 1948; of Dyneema lines, Vlasblom et al. 2006.
struct TendonCreep {
  static constexpr About about{"tendon_creep", Stage::tendon, Seat::actuator,
                               "tension held for long after a step"};

  double stiffness_N_per_m = 0;  // κ₁
  double time_constant_s = 3;    // T

  void visit(auto& v) {
    v("stiffness_N_per_m", stiffness_N_per_m, Bounds{0, 1e5});
    v("time_constant_s", time_constant_s, Bounds{0.1, 60});
  }
  Sloped pull(const ChainSample& s, Memory& memory) const {
    double &flowed_m = memory[0], &began = memory[1];
    const double x_m = drawn_m(s);
    if (began == 0) flowed_m = x_m, began = 1;
    flowed_m += (x_m - flowed_m) * -std::expm1(-s.dt_s / time_constant_s);
    return {stiffness_N_per_m * (x_m - flowed_m), stiffness_N_per_m};
  }
};

}  // namespace sim::effects
