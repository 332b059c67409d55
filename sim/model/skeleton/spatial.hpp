#pragma once
#include <Eigen/Geometry>

#include "sim/model/skeleton/pose.hpp"

/// Spatial vectors in the world's frame: angular part above, linear part below, both about the
/// world's origin. In this form velocities are summed from the root outwards, and forces
/// and inertias from the tips to the root.
/// Source: Featherstone, Rigid Body Dynamics Algorithms, 2008, chapter 2.
namespace sim {

using Vec6 = Eigen::Matrix<double, 6, 1>;

inline Vec6 spatial(const Vec3& angular, const Vec3& linear) {
  Vec6 v;
  v << angular, linear;
  return v;
}

/// Spatial velocity of a unit rotation about an axis through a point.
inline Vec6 turning(const Vec3& axis, const Vec3& at_m) { return spatial(axis, at_m.cross(axis)); }

/// A force at a point as a wrench: moment and force.
inline Vec6 wrench(const Vec3& at_m, const Vec3& force_N) {
  return spatial(at_m.cross(force_N), force_N);
}

/// v × m: cross product with a motion vector m.
inline Vec6 cross_motion(const Vec6& v, const Vec6& m) {
  const Vec3 w = v.head<3>(), l = v.tail<3>(), a = m.head<3>(), b = m.tail<3>();
  return spatial(w.cross(a), w.cross(b) + l.cross(a));
}

/// v ×* f: cross product with a force vector f.
inline Vec6 cross_force(const Vec6& v, const Vec6& f) {
  const Vec3 w = v.head<3>(), l = v.tail<3>(), n = f.head<3>(), p = f.tail<3>();
  return spatial(w.cross(n) + l.cross(p), w.cross(p));
}

/// Inertia of a rigid body, or of several bodies that move as one: mass, first moment and second
/// moment about the world's origin.
struct SpatialInertia {
  double mass_kg = 0;
  Vec3 moment_kg_m = Vec3::Zero();                         ///< m c
  Eigen::Matrix3d second_kg_m2 = Eigen::Matrix3d::Zero();  ///< I about the origin

  /// From mass m, centre of mass c, and the inertia about c in axes rotated by `rotation`.
  static SpatialInertia of(double mass_kg, const Vec3& com_m, const Eigen::Matrix3d& rotation,
                           const Eigen::Matrix3d& inertia_kg_m2) {
    Eigen::Matrix3d second = rotation * inertia_kg_m2 * rotation.transpose();
    second +=
        mass_kg * (com_m.squaredNorm() * Eigen::Matrix3d::Identity() - com_m * com_m.transpose());
    return {mass_kg, mass_kg * com_m, second};
  }
  SpatialInertia& operator+=(const SpatialInertia& other) {
    mass_kg += other.mass_kg;
    moment_kg_m += other.moment_kg_m;
    second_kg_m2 += other.second_kg_m2;
    return *this;
  }
  Vec6 operator*(const Vec6& v) const {
    const Vec3 w = v.head<3>(), l = v.tail<3>();
    return spatial(second_kg_m2 * w + moment_kg_m.cross(l), mass_kg * l - moment_kg_m.cross(w));
  }
};

}  // namespace sim
