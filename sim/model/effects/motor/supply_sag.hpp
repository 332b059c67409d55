#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// The supply voltage drops with the current d i that the bridge draws.
///
///   V' = d (V_s − R_s d i) = V − d² R_s i,   d = V / V_s:   R' = R + d² R_s
///
/// Models the lead of each actuator; ignores the current of other actuators.
/// Source: Thévenin's equivalent of a supply behind an averaged H-bridge.
struct SupplySag {
  static constexpr About about{"motor_supply_sag", Stage::motor, Seat::actuator,
                               "high current at high voltage and at low voltage"};

  double source_ohm = 0;  // R_s

  void visit(auto& v) { v("source_ohm", source_ohm, Bounds{0, 3}); }
  double resistance_ohm(double ohm, const ChainSample& s, Memory&) const {
    const double duty = s.voltage_V / s.supply_V;
    return ohm + duty * duty * source_ohm;
  }
};

}  // namespace sim::effects
