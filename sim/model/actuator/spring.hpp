#pragma once
#include <cmath>
#include <stdexcept>

#include "interfaces/robot/actuator.hpp"

/// Elasticity of a tendon: a spring, which may stiffen with stretch, in series with the line.
///
///   F = κ x_s + κ₃ x_s³,   Δx = x_s + F / κ_line          κ_line: stiffness of the
///                                         line; not given: inextensible
///
/// F(Δx) and Δx(F) are solved by Newton's method to rounding. It converges because Δx is a convex,
/// increasing function of x_s ≥ 0. Ignores hysteresis, and the dependence of the line's stiffness
/// on its unwound length.
namespace sim {

struct Spring {
  double stiffness_N_per_m;            ///< κ
  double cubic_N_per_m3 = 0;           ///< κ₃
  double line_compliance_m_per_N = 0;  ///< 1 / κ_line

  /// Throws std::invalid_argument for a stiffness that is not positive.
  static Spring of(const erp::Tendon& tendon) {
    if (!(tendon.stiffness_N_per_m > 0))
      throw std::invalid_argument("stiffness_N_per_m must be positive");
    return {tendon.stiffness_N_per_m, tendon.cubic_N_per_m3,
            tendon.line_stiffness_N_per_m ? 1 / *tendon.line_stiffness_N_per_m : 0.0};
  }

  /// F at a stretch Δx; zero if slack.
  double force_N(double stretch_m) const {
    return stretch_m > 0 ? spring_force_N(spring_stretch_m(stretch_m)) : 0.0;
  }
  /// ∫ F dΔx from 0: energy stored in the spring and the line.
  double energy_J(double stretch_m) const {
    if (!(stretch_m > 0)) return 0;
    const double x = spring_stretch_m(stretch_m), force_N = spring_force_N(x);
    return x * x * (stiffness_N_per_m / 2 + cubic_N_per_m3 * x * x / 4) +
           force_N * force_N * line_compliance_m_per_N / 2;
  }
  /// dF/dΔx.
  double slope_N_per_m(double stretch_m) const {
    const double spring_slope = spring_slope_N_per_m(spring_stretch_m(std::fmax(0.0, stretch_m)));
    return spring_slope / (1 + line_compliance_m_per_N * spring_slope);
  }
  /// Δx at a force F.
  double stretch_m(double force_N) const {
    double x = force_N / stiffness_N_per_m;  // an upper bound, from which Newton's steps decrease
    for (int k = 0; k < max_steps && cubic_N_per_m3 > 0; ++k) {
      const double step = (spring_force_N(x) - force_N) / spring_slope_N_per_m(x);
      x -= step;
      if (!(step > rounding * x)) break;
    }
    return x + force_N * line_compliance_m_per_N;
  }

 private:
  static constexpr int max_steps = 60;  // chosen
  static constexpr double rounding = 1e-15;
  double spring_force_N(double x) const { return x * (stiffness_N_per_m + cubic_N_per_m3 * x * x); }
  double spring_slope_N_per_m(double x) const {
    return stiffness_N_per_m + 3 * cubic_N_per_m3 * x * x;
  }
  /// x_s at a stretch Δx.
  double spring_stretch_m(double stretch_m) const {
    double x = stretch_m / (1 + line_compliance_m_per_N * stiffness_N_per_m);
    if (line_compliance_m_per_N == 0 || cubic_N_per_m3 == 0) return x;
    for (int k = 0; k < max_steps; ++k) {
      const double step = (x + line_compliance_m_per_N * spring_force_N(x) - stretch_m) /
                          (1 + line_compliance_m_per_N * spring_slope_N_per_m(x));
      x -= step;
      if (!(step > rounding * x)) break;
    }
    return x;
  }
};

}  // namespace sim
