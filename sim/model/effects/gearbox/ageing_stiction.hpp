#pragma once
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Dry friction that increases while the shaft is at rest and decreases as it turns.
///
///   τ_CG' = τ_CG + a z,   dz/dt = (1 − z)/T − |ω| z/θ_s          z(0) = 0
///
/// Exact for a step at constant speed.
/// Source: Rabinowicz, Proc. Phys. Soc. 71, 1958 (rest time); Dieterich, J. Geophys. Res. 84, 1979
/// (slip distance after which it has decayed).
struct GearboxAgeingStiction {
  static constexpr About about{"gearbox_ageing_stiction", Stage::gearbox, Seat::actuator,
                               "starts after rest periods of different lengths"};

  double extra_Nm = 0;   // a
  double rest_s = 1;     // T
  double way_rad = 0.1;  // θ_s

  void visit(auto& v) {
    v("extra_Nm", extra_Nm, Bounds{0, 10});
    v("rest_s", rest_s, Bounds{0.05, 20});
    v("way_rad", way_rad, Bounds{0.01, 2});
  }
  double aged_Nm(const ChainSample& s, Memory& memory) const {
    const double rate_per_s = 1 / rest_s + std::abs(s.speed_rad_per_s) / way_rad;
    const double steady = 1 / (rest_s * rate_per_s);
    double& z = memory[0];
    z = steady + (z - steady) * std::exp(-rate_per_s * s.dt_s);
    return extra_Nm * z;
  }
};

}  // namespace sim::effects
