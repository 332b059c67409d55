#pragma once
#include "sim/model/effects/effect.hpp"
#include "sim/model/effects/softer_line.hpp"

namespace sim::effects {

/// Elasticity of the line.
///
///   Δx = x_spring + c F l/l₀
///
/// l: free line length, unstretched: path − Δx; l₀: path at the start.
///
/// The wound line does not stretch, because friction on the spindle holds it. With the stiffness κ
/// of spring and line at its initial length, δF = −κ Δx κε/(1 + κε), ε = c (l/l₀ − 1).
/// Source: paper, 4.1 (kite lines taken as inextensible).
struct TendonKiteLine {
  static constexpr About about{"tendon_kite_line", Stage::tendon, Seat::actuator,
                               "several tensions at several stretches"};

  static constexpr bool acts_per_step = true;  // `pull`, in addition to `change_actuator`

  double compliance_m_per_N = 0;  // c

  void visit(auto& v) { v("compliance_m_per_N", compliance_m_per_N, Bounds{0, 0.001}); }
  Sloped pull(const ChainSample& s, Memory&) const {
    const double start_m = s.path_m - s.path_change_m;
    if (!(start_m > 0) || !(s.stretch_m > 0)) return {};
    const double extra_compliance_m_per_N =
                     compliance_m_per_N * (s.path_change_m - s.stretch_m) / start_m,
                 k = s.stiffness_N_per_m;
    const double slope_change_N_per_m =
        k * k * extra_compliance_m_per_N / (1 + k * extra_compliance_m_per_N);
    return {-slope_change_N_per_m * s.stretch_m, -slope_change_N_per_m};
  }
  void change_actuator(auto& actuator) const { soften_line(actuator.tendon, compliance_m_per_N); }
};

}  // namespace sim::effects
