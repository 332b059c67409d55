#pragma once
#include <algorithm>

#include "interfaces/robot/robot.hpp"
#include "sim/model/actuator/spring.hpp"

/// Series elastic tendon on a spindle (paper, eqs 1, 2, 4).
///
///   F = f(Δx) + D dΔx/dt,  Δx = L_T − (L_K + L_R)       F = 0 if Δx ≤ 0 or the sum is negative
///   L_K = L_K0 − r θ                                    dΔx/dt = dL_T/dt + r ω
///
/// L_T length of the path, L_K of the kite line, L_R of the spring at rest; r spindle radius,
/// θ, ω angle and speed of the gearbox shaft, positive winding up. Only the sum L_K0 + L_R
/// matters; it is `rest_m` here. A slack tendon (Δx ≤ 0) has no tension at any rate. The
/// paper's equation differs: there the damper also acts on a slack tendon.
///
/// Ignores: mass and bending of the line, layers on the spindle, hysteresis.
namespace sim {

struct TendonLaw {
  Spring spring;             ///< f; κ Δx for a linear spring
  double damping_N_s_per_m;  ///< D
  double radius_m;           ///< r
  double rest_m;             ///< L_K0 + L_R

  /// The law whose tension is the pretension at path length `length_m` and shaft angle 0.
  static TendonLaw at_rest(const erp::Tendon& tendon, const erp::Spindle& spindle,
                           double length_m) {
    const Spring spring = Spring::of(tendon);
    return {spring, tendon.damping_N_s_per_m, spindle.radius_m,
            length_m - spring.stretch_m(tendon.pretension_N)};
  }

  /// Δx; negative: slack.
  double stretch_m(double length_m, double shaft_rad) const {
    return length_m - rest_m + radius_m * shaft_rad;
  }
  /// Change of L_K since the start; negative: wound up.
  double line_m(double shaft_rad) const { return -radius_m * shaft_rad; }
  /// L_T of a taut tendon with spring force `spring_N`: the path length from the actuator's own
  /// sensors.
  double length_m(double spring_N, double shaft_rad) const {
    return rest_m + line_m(shaft_rad) + spring.stretch_m(spring_N);
  }

  double tension_N(double length_m, double length_rate_m_per_s, double shaft_rad,
                   double speed_rad_per_s) const {
    const double stretch = stretch_m(length_m, shaft_rad);
    const double rate = length_rate_m_per_s + radius_m * speed_rad_per_s;
    return stretch > 0 ? std::max(0.0, spring.force_N(stretch) + damping_N_s_per_m * rate) : 0.0;
  }
};

}  // namespace sim
