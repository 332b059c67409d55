#pragma once
#include <Eigen/Core>

/// The shortest line from A to B around a sphere, frictionless: a spherical pulley (paper, 4.2).
///
///   a = |A|, b = |B| from the centre, φ the angle from A to B on the way the tendon takes
///   α = acos(r/a), β = acos(r/b)
///   φ > α + β:  L = √(a²−r²) + √(b²−r²) + r (φ − α − β)        else  L = |AB|
///
/// The way lies in the plane of A, B and the centre. Without a side it is the shorter one (φ ≤ π).
/// With a side it is the one whose middle points to that side: side·(A/a + B/b) < 0 takes the long
/// way, φ up to 2π, and L stays continuous through φ = π in a plane that holds the side.
/// In space φ = π is singular without remedy: every plane is as short; keep routings away from it.
///
/// L is C¹ where the line lifts off. Ignores friction, and that a cord on a sphere may slip.
namespace sim {

using Vec3 = Eigen::Vector3d;

struct SphereWrap {
  double length_m = 0;
  double angle_rad = 0;  ///< on the sphere; 0 when the line does not touch
  bool touches = false;
  Vec3 entry_m, exit_m;  ///< where it touches, from the centre; unset when it does not
  bool inside = false;   ///< an end lies inside the sphere: no answer, the straight line is given
};

/// A, B and side relative to the sphere's centre, in one frame. `side` zero: the shorter way.
SphereWrap wrap_sphere(const Vec3& a_m, const Vec3& b_m, double radius_m, const Vec3& side);

}  // namespace sim
