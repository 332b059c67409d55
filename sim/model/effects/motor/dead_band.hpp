#pragma once
#include <algorithm>
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Voltage drop of bridge and brushes: no current flows below V₀.
///
///   V' = sgn(V) max(0, |V| − V₀)
///
/// Source: brush drop, Krause et al., Analysis of Electric Machinery, 2013, ch. 2.
struct MotorDeadBand {
  static constexpr About about{"motor_dead_band", Stage::motor, Seat::actuator,
                               "small voltages of both signs"};

  double volts = 0;  // V₀

  void visit(auto& v) { v("volts", volts, Bounds{0, 3}); }
  double voltage_V(double applied_V, const ChainSample&) const {
    return std::copysign(std::max(0.0, std::abs(applied_V) - volts), applied_V);
  }
};

}  // namespace sim::effects
