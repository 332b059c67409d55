#pragma once
#include <algorithm>

#include "sim/model/actuator/tendon.hpp"
#include "sim/world/step_solver.hpp"

/// A tendon over a time step, implicit in the motion at its end.
///
///   f = F + κ (c₁ dt ẋ + c₂ dt ẋ⁺) + D ((1 − θ_D) ẋ + θ_D ẋ⁺),   ẋ = J v + r ω    0 where slack
///     = a + G J v⁺,   G = κ c₂ dt + D θ_D,   a = F + (κ c₁ dt + D (1 − θ_D)) ẋ + G r ω
///
/// F(x) the spring's force, κ = dF/dx, J the gradient of its stretch x with respect to the joints,
/// at the start of the step. With positions moved by q⁺ = q + dt v⁺, an oscillator of k = dt² κ J W
/// Jᵀ keeps (1 − k c₁)/(1 + k c₂) of its phase space in each step, so
///
///   c₁ = (θ − 1)/2, c₂ = (3θ − 1)/2:   θ = ½ conserves it, θ = 1 is backward Euler;
///   both are stable for any stiffness.
///
/// By default θ = ½ + ½ k/(4 + k). If the step resolves the oscillation, energy is conserved to
/// fourth order in dt; otherwise it is dissipated. For the damper, with m = dt D J W Jᵀ, θ_D = (1 +
/// m)/(2 + m). A damper without a spring then reduces a speed by the factor 1/(1 + m + m²/2), which
/// is e^−m to second order.
/// Source: linearised implicit integration (Baraff, Witkin 1998); c₁, c₂, θ(k) and θ_D(m) are
/// chosen here.
namespace sim {

struct StretchedTendon {
  double stiffness_N_per_m = 0, damping_N_s_per_m = 0;  ///< κ, D
  double stretch_m = 0;                                 ///< x
  double spring_N = 0;                                  ///< F, extended below x = 0 by its slope
  double rate_m_per_s = 0;                              ///< ẋ
  double winding_m_per_s = 0;                           ///< r ω
};

/// `stretch_m` x, `rate_m_per_s` ẋ, `winding_m_per_s` r ω.
inline StretchedTendon stretched(const TendonLaw& law, double stretch_m, double rate_m_per_s,
                                 double winding_m_per_s) {
  const double slope = law.spring.slope_N_per_m(stretch_m);
  const double force = stretch_m > 0 ? law.spring.force_N(stretch_m) : slope * stretch_m;
  return {slope, law.damping_N_s_per_m, stretch_m, force, rate_m_per_s, winding_m_per_s};
}

/// Weight of the end of the step in the forces.
struct Implicitness {
  double spring = 1, damper = 1;  ///< θ, θ_D
};

/// `mobility_per_kg` J W Jᵀ.
inline Implicitness implicitness_of(const StretchedTendon& t, double mobility_per_kg, double dt_s) {
  const double k = dt_s * dt_s * t.stiffness_N_per_m * mobility_per_kg;
  const double m = dt_s * t.damping_N_s_per_m * mobility_per_kg;
  return {0.5 + 0.5 * k / (4 + k), (1 + m) / (2 + m)};
}

/// Sets a and G of a force whose row is J; a tendon that is slack over the step exerts no force.
inline void pull_implicitly(const StretchedTendon& t, const Implicitness& theta, double dt_s,
                            OneSidedForce& force) {
  const double c1 = (theta.spring - 1) / 2, c2 = (3 * theta.spring - 1) / 2;
  const double start_gain_N_s_per_m =
      t.stiffness_N_per_m * c1 * dt_s + t.damping_N_s_per_m * (1 - theta.damper);
  force.gain_N_s_per_m = t.stiffness_N_per_m * c2 * dt_s + t.damping_N_s_per_m * theta.damper;
  force.start_N =
      t.spring_N + start_gain_N_s_per_m * t.rate_m_per_s + force.gain_N_s_per_m * t.winding_m_per_s;
  const bool slack = t.stretch_m + dt_s * std::max(0.0, t.rate_m_per_s) <= 0;
  if (slack) force.start_N = 0, force.row.clear();
}

}  // namespace sim
