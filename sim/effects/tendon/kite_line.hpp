#pragma once
#include "sim/effects/effect.hpp"
#include "sim/effects/softer_line.hpp"

namespace sim::effects {

/// The line itself stretches.
///
///   Δx = x_spring + c F
///
/// Its stiffness is that of its whole length, wound or not. Of a plain spring nearly the same as a
/// softer one: only the damping tells.
/// Source: paper, 4.1 (kite lines taken as inextensible).
struct TendonKiteLine {
  static constexpr About about{"tendon_kite_line", Stage::tendon, Seat::actuator,
                               "several tensions at several stretches"};

  double compliance_m_per_N = 0;  // c

  void visit(auto& v) { v("compliance_m_per_N", compliance_m_per_N, Bounds{0, 0.001}); }
  void change_actuator(auto& actuator) const { soften_line(actuator.tendon, compliance_m_per_N); }
};

}  // namespace sim::effects
