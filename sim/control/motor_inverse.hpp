#pragma once
#include "interfaces/robot/robot.hpp"

/// Current and voltage of a motor for a desired motion: eq. 3 of the paper, solved for its input.
///
///   i = ((r F + µ_G ω + s τ_CG + J_G ω̇)/(e N) + µ_M N ω + s τ_CM + J_M N ω̇) / K_T
///   V = R i + K_E N ω                                              without inductance
///
/// e is the gear's efficiency for the direction of power: η if the motor drives, 1/η if the load
/// drives; s = sgn ω. Both are smoothed below a creep speed, because a shaft may stick there.
namespace sim {

class MotorInverse {
 public:
  /// `creep_rad_per_s`: by default 0.6 % of a 12 V motor's top speed; chosen.
  MotorInverse(const erp::MotorType& motor, double spindle_radius_m, double creep_rad_per_s = 0.05)
      : motor_(motor), radius_m_(spindle_radius_m), creep_rad_per_s_(creep_rad_per_s) {}

  double current_A(double tension_N, double speed_rad_per_s, double acceleration_rad_per_s2) const;
  double voltage_V(double tension_N, double speed_rad_per_s, double acceleration_rad_per_s2) const {
    return motor_.resistance_ohm * current_A(tension_N, speed_rad_per_s, acceleration_rad_per_s2) +
           motor_.back_emf_V_s_per_rad * motor_.gear_ratio * speed_rad_per_s;
  }
  double radius_m() const { return radius_m_; }

 private:
  erp::MotorType motor_;
  double radius_m_, creep_rad_per_s_;
};

}  // namespace sim
