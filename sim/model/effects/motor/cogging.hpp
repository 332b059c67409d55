#pragma once
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Cogging torque: the magnets attract the rotor's teeth with a torque that is periodic in its angle.
///
///   τ = a sin n N θ + b cos n N θ          positive against winding up, on the motor's shaft
///
/// The mean over the rotation in a step is applied.
/// Source: Hanselman, Brushless Permanent Magnet Motor Design, 2006, ch. 7.
struct MotorCogging {
  static constexpr About about{"motor_cogging", Stage::motor, Seat::actuator,
                               "very slow turning under a constant load"};

  double sine_Nm = 0, cosine_Nm = 0;  // a, b; on the motor's shaft
  double periods_per_turn = 12;       // n, of the motor's shaft

  void visit(auto& v) {
    v("sine_Nm", sine_Nm, Bounds{-0.02, 0.02});
    v("cosine_Nm", cosine_Nm, Bounds{-0.02, 0.02});
    v.shape("periods_per_turn", periods_per_turn, Bounds{1, 100});
  }
  double rotor_Nm(const ChainSample& s) const {
    const double turns = periods_per_turn * s.gear_ratio;
    const double phase = turns * s.shaft_rad, swept = turns * s.speed_rad_per_s * s.dt_s / 2;
    const double mean = std::abs(swept) > 1e-6 ? std::sin(swept) / swept : 1;
    return mean * (sine_Nm * std::sin(phase) + cosine_Nm * std::cos(phase));
  }
};

}  // namespace sim::effects
