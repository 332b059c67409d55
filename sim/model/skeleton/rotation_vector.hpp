#pragma once
#include <Eigen/LU>
#include <cmath>

#include "sim/model/skeleton/pose.hpp"

/// Angular velocity and acceleration of a rotation R = exp [u]×, in the frame of the rotating body:
///
///   ω = J u̇,   J = 1 − a [u]× + b [u]×²,   a = (1 − cos θ)/θ²,  b = (θ − sin θ)/θ³,  θ = |u|
///   α = J ü + β,   β = −ȧ u × u̇ + ḃ u × (u × u̇) + b u̇ × (u × u̇)
///
/// Source: Solà 2017, Quaternion kinematics for the error-state Kalman filter, §4.3; α by
/// differentiation. For |u| < 2π.
namespace sim {

class RotationVector {
 public:
  explicit RotationVector(const Vec3& u) : u_(u) {
    const double square = u.squaredNorm(), angle = std::sqrt(square);
    if (angle < 1e-2) {  // series expansion, error below 1e-11
      a_ = 1.0 / 2 - square / 24, b_ = 1.0 / 6 - square / 120;
      da_ = -1.0 / 12 + square / 180, db_ = -1.0 / 60 + square / 1260;
      return;
    }
    const double sine = std::sin(angle), versine = 1 - std::cos(angle);
    a_ = versine / square, b_ = (angle - sine) / (square * angle);
    da_ = (angle * sine - 2 * versine) / (square * square);
    db_ = (angle * versine - 3 * (angle - sine)) / (square * square * angle);
  }

  Vec3 speed(const Vec3& rate) const { return jacobian() * rate; }
  Vec3 acceleration(const Vec3& rate, const Vec3& rate_of_rate) const {
    return jacobian() * rate_of_rate + velocity_product(rate);
  }
  /// u̇ and ü of a body that rotates with ω and α.
  Vec3 rate(const Vec3& speed) const { return jacobian().inverse() * speed; }
  Vec3 rate_of_rate(const Vec3& rate, const Vec3& acceleration) const {
    return jacobian().inverse() * (acceleration - velocity_product(rate));
  }

 private:
  Eigen::Matrix3d jacobian() const {
    Eigen::Matrix3d cross;
    cross << 0, -u_.z(), u_.y(), u_.z(), 0, -u_.x(), -u_.y(), u_.x(), 0;
    return Eigen::Matrix3d::Identity() - a_ * cross + b_ * cross * cross;
  }
  Vec3 velocity_product(const Vec3& rate) const {
    const Vec3 turned = u_.cross(rate);
    const double along = u_.dot(rate);
    return along * (-da_ * turned + db_ * u_.cross(turned)) + b_ * rate.cross(turned);
  }

  Vec3 u_;
  double a_, b_, da_, db_;  ///< da: (da/dθ)/θ; then ȧ = da u·u̇
};

}  // namespace sim
