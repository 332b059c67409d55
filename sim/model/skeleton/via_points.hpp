#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "sim/model/skeleton/pose.hpp"

/// Minimum-jerk trajectory through via points (Flash and Hogan 1985): of all trajectories through
/// given points at given times, the one with minimum ∫ jerk² dt. Each segment is a fifth-degree
/// polynomial,
///
///   x(s) = c₁ s + … + c₅ s⁵,   s = (t − t_k)/T,   x(1) = Δ_k
///
/// determined by Δ and by velocity and acceleration at both ends, which are the unknowns.
namespace sim {

/// c₁ … c₅ from Δ and the first and second derivatives by s, V and A, at both ends.
struct Quintic {
  Eigen::Matrix<double, 5, 1> c;
  static Quintic between(double delta, double v0, double a0, double v1, double a1);
};

/// A segment u(s) of three dimensions, with u(0) = 0.
struct QuinticSegment {
  std::array<std::array<double, 3>, 5> c;  ///< arrays, not Eigen vectors, to avoid their alignment
  struct Place {
    Vec3 u, rate, rate_of_rate;  ///< u and its derivatives by s
  };
  static QuinticSegment between(const Vec3& delta, const Vec3& v0, const Vec3& a0, const Vec3& v1,
                                const Vec3& a1);
  Place at(double s) const;
};

/// Velocities and accelerations at the points: points × dimensions.
struct ViaMotions {
  Eigen::MatrixXd velocity, acceleration;
};

/// `times_s`: increasing times of the points. `deltas`: Δ, segments × dimensions. `rests`: points
/// with zero velocity and acceleration; always true for the first and the last.
ViaMotions minimum_jerk_through(const std::vector<double>& times_s, const Eigen::MatrixXd& deltas,
                                std::vector<bool> rests);

}  // namespace sim
