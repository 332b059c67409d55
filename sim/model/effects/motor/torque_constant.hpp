#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// A weaker or stronger magnet: torque constant and back-EMF constant change by the same factor.
///
///   K_T' = (1 + a) K_T,   K_E' = (1 + a) K_E
///
/// Source: paper, eq. 3; magnets lose about 0.2 %/K (NdFeB data sheets).
struct MotorTorqueConstant {
  static constexpr About about{"motor_torque_constant", Stage::motor, Seat::actuator,
                               "high speed and known loads"};

  double relative = 0;  // a

  void visit(auto& v) { v("relative", relative, Bounds{-0.6, 1}); }
  void change_motor(auto& motor) const {
    motor.torque_Nm_per_A *= 1 + relative;
    motor.back_emf_V_s_per_rad *= 1 + relative;
  }
};

}  // namespace sim::effects
