#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Change of the circuit's resistance: winding, brushes, leads.
///
///   R' = (1 + a) R
///
/// Source: data sheets state tolerances of ±10 % and more.
struct MotorResistance {
  static constexpr About about{"motor_resistance", Stage::motor, Seat::actuator,
                               "high current and high speed, at different times"};

  double relative = 0;  // a

  void visit(auto& v) { v("relative", relative, Bounds{-0.6, 2}); }
  void change_motor(auto& motor) const { motor.resistance_ohm *= 1 + relative; }
};

}  // namespace sim::effects
