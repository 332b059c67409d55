#pragma once
#include <Eigen/Geometry>

#include "sim/skeleton/pose.hpp"

/// Spatial vectors: angular part above, linear part below, about a frame's own origin and axes.
/// Source: Featherstone, Rigid Body Dynamics Algorithms, 2008, chapter 2.
namespace sim {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

inline Eigen::Matrix3d skew(const Vec3& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

inline Vec6 spatial(const Vec3& angular, const Vec3& linear) {
  Vec6 v;
  v << angular, linear;
  return v;
}

/// A child's frame in its parent's: turned by `rotation` (child to parent), its origin at `at_m`.
struct Placement {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vec3 at_m = Vec3::Zero();

  /// A velocity or acceleration of the parent, as the child's frame sees it.
  Vec6 motion_to_child(const Vec6& v) const {
    const Vec3 angular = v.head<3>(), linear = v.tail<3>();
    return spatial(rotation.transpose() * angular,
                   rotation.transpose() * (linear + angular.cross(at_m)));
  }
  /// A moment and force on the child, as the parent feels them.
  Vec6 force_to_parent(const Vec6& f) const {
    const Vec3 force = rotation * f.tail<3>();
    return spatial(rotation * f.head<3>() + at_m.cross(force), force);
  }
  /// The matrix of `motion_to_child`; its transpose is `force_to_parent`'s.
  Mat6 matrix() const {
    const Eigen::Matrix3d e = rotation.transpose();
    Mat6 x;
    x << e, Eigen::Matrix3d::Zero(), -e * skew(at_m), e;
    return x;
  }
};

/// v × m for motions.
inline Vec6 cross_motion(const Vec6& v, const Vec6& m) {
  const Vec3 w = v.head<3>(), l = v.tail<3>(), a = m.head<3>(), b = m.tail<3>();
  return spatial(w.cross(a), w.cross(b) + l.cross(a));
}

/// v ×* f for forces.
inline Vec6 cross_force(const Vec6& v, const Vec6& f) {
  const Vec3 w = v.head<3>(), l = v.tail<3>(), n = f.head<3>(), p = f.tail<3>();
  return spatial(w.cross(n) + l.cross(p), w.cross(p));
}

/// Of mass m with its centre at c and inertia I about it, about the frame's origin.
inline Mat6 spatial_inertia(double mass_kg, const Vec3& com_m, const Vec3& inertia_kg_m2) {
  const Eigen::Matrix3d c = skew(com_m);
  Mat6 i;
  i << Eigen::Matrix3d(inertia_kg_m2.asDiagonal()) + mass_kg * c * c.transpose(), mass_kg * c,
      mass_kg * c.transpose(), mass_kg * Eigen::Matrix3d::Identity();
  return i;
}

}  // namespace sim
