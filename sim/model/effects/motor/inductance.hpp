#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Change of the winding's inductance.
///
///   L' = (1 + a) L
///
/// Source: paper, eq. 3.
struct MotorInductance {
  static constexpr About about{"motor_inductance", Stage::motor, Seat::actuator,
                               "voltage steps, with the current sampled within L/R"};

  double relative = 0;  // a

  void visit(auto& v) { v("relative", relative, Bounds{-0.8, 30}); }
  void change_motor(auto& motor) const { motor.inductance_H *= 1 + relative; }
};

}  // namespace sim::effects
