#pragma once
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Cogging torque: the magnets attract the rotor's teeth with a torque that is periodic in its
/// angle.
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
    constexpr double min_half_swept_rad = 1e-6;  // below: sin x / x is 1 to rounding
    const double periods_per_shaft_rad = periods_per_turn * s.gear_ratio;
    const double phase = periods_per_shaft_rad * s.shaft_rad,
                 half_swept_rad = periods_per_shaft_rad * s.speed_rad_per_s * s.dt_s / 2;
    const double mean = std::abs(half_swept_rad) > min_half_swept_rad
                            ? std::sin(half_swept_rad) / half_swept_rad
                            : 1;
    return mean * (sine_Nm * std::sin(phase) + cosine_Nm * std::cos(phase));
  }
};

}  // namespace sim::effects
