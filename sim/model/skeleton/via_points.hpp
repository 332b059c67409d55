#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "sim/model/skeleton/pose.hpp"

/// The least jerk through via points (Flash and Hogan 1985): of all ways that pass points at given
/// times, that of least ∫ jerk² dt. Between two points it is a polynomial of the fifth degree,
///
///   x(s) = c₁ s + … + c₅ s⁵,   s = (t − t_k)/T,   x(1) = Δ_k
///
/// given by Δ, and velocity and acceleration at both its ends; those at the points are what is sought.
namespace sim {

/// c₁ … c₅ from Δ, and velocities V and accelerations A by s at both ends.
struct Quintic {
  Eigen::Matrix<double, 5, 1> c;
  static Quintic between(double way, double v0, double a0, double v1, double a1);
};

/// Three at a time: u(s) from u(0) = 0.
struct QuinticWay {
  std::array<std::array<double, 3>, 5> c;  ///< no alignment: rows of messages live beside it
  struct Place {
    Vec3 u, rate, rate_of_rate;  ///< by s
  };
  static QuinticWay between(const Vec3& way, const Vec3& v0, const Vec3& a0, const Vec3& v1,
                            const Vec3& a1);
  Place at(double s) const;
};

/// Velocities and accelerations in the points: points × directions.
struct ViaMotions {
  Eigen::MatrixXd velocity, acceleration;
};

/// `times_s`: of the points, rising. `ways`: Δ, segments × directions. `rests`: points of no motion;
/// the first and the last are such.
ViaMotions least_jerk_through(const std::vector<double>& times_s, const Eigen::MatrixXd& ways,
                              std::vector<bool> rests);

}  // namespace sim
