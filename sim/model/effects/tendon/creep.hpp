#pragma once
#include <cmath>

#include "sim/model/effects/taut_stretch.hpp"

namespace sim::effects {

/// At constant stretch the tension relaxes to that of the spring (Zener body).
///
///   F = f(x) + κ₁ (x − y),   dy/dt = (x − y) / T
///
/// x: stretch, 0 if slack. y starts at the first x, as for a tendon at rest.
/// Source: Zener 1948; for Dyneema lines, Vlasblom et al. 2006.
struct TendonCreep {
  static constexpr About about{"tendon_creep", Stage::tendon, Seat::actuator,
                               "a step of the tension, then held for a long time"};

  double stiffness_N_per_m = 0;  // κ₁
  double time_constant_s = 3;    // T

  void visit(auto& v) {
    v("stiffness_N_per_m", stiffness_N_per_m, Bounds{0, 1e5});
    v("time_constant_s", time_constant_s, Bounds{0.1, 60});
  }
  Sloped pull(const ChainSample& s, Memory& memory) const {
    double &creep_m = memory[0], &initialized = memory[1];
    const double x_m = taut_stretch_m(s);
    if (initialized == 0) creep_m = x_m, initialized = 1;
    creep_m += (x_m - creep_m) * -std::expm1(-s.dt_s / time_constant_s);
    return {stiffness_N_per_m * (x_m - creep_m), stiffness_N_per_m};
  }
};

}  // namespace sim::effects
