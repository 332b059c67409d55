#pragma once
#include <Eigen/Core>
#include <optional>

/// The shortest line from A to B around a pulley, frictionless (paper, 4.2).
///
///   a = |A|, b = |B| from the centre, φ the angle from A to B on the way the tendon takes
///   α = acos(r/a), β = acos(r/b)
///   φ > α + β:  L = √(a²−r²) + √(b²−r²) + r (φ − α − β)        else  L = |AB|
///
/// Sphere: the way lies in the plane of A, B and the centre. Without a side it is the shorter one
/// (φ ≤ π). With a side it is the one whose middle points to that side: side·(A/a + B/b) < 0 takes
/// the long way, φ up to 2π, and L stays continuous through φ = π in a plane that holds the side.
/// In space φ = π is singular without remedy: every plane is as short; keep routings away from it.
///
/// With an axis the way runs right-handed about it and its turns are counted: of all φ + 2πn the
/// one nearest to the last. Cylinder: the same in the plane across its axis, L_⊥; unrolled, the
/// line is straight: L = √(L_⊥² + z²), z from A to B along the axis.
///
/// A sphere with an axis leaps where the plane of A, B and the centre comes to hold the axis: keep
/// such lines about across it, or take a cylinder, which has no such place.
///
/// L is C¹ where the line lifts off. Ignores friction, and that a cord on a sphere may slip.
namespace sim {

using Vec3 = Eigen::Vector3d;

struct Wrap {
  double length_m = 0;                    ///< from A to B
  double wrapped_m = 0, wrapped_rad = 0;  ///< on the pulley; 0 when the line does not touch
  bool touches = false;
  Vec3 entry_m, exit_m;        ///< where it touches, from the centre; unset when it does not
  Vec3 about = Vec3::UnitZ();  ///< the way turns right-handed about it
  double around_rad = 0;       ///< φ, its turns counted
  bool inside = false;         ///< an end lies inside: no answer, the straight line is given
};

/// A, B and side relative to the sphere's centre, in one frame. `side` zero: the shorter way.
Wrap wrap_sphere(const Vec3& a_m, const Vec3& b_m, double radius_m, const Vec3& side);

/// About an axis (a unit vector); `last_rad`: the last φ.
Wrap wrap_sphere_about(const Vec3& a_m, const Vec3& b_m, double radius_m, const Vec3& axis,
                       double last_rad);
Wrap wrap_cylinder(const Vec3& a_m, const Vec3& b_m, double radius_m, const Vec3& axis,
                   double last_rad);

}  // namespace sim
