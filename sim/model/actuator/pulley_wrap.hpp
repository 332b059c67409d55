#pragma once
#include <Eigen/Core>
#include <optional>

/// The shortest frictionless line from A to B around a pulley (paper, 4.2).
///
///   a = |A|, b = |B| from the centre, φ the angle from A to B in the direction of wrapping
///   α = acos(r/a), β = acos(r/b)
///   φ > α + β:  L = √(a²−r²) + √(b²−r²) + r (φ − α − β)        else  L = |AB|
///
/// Sphere: the line lies in the plane of A, B and the centre. Without a side it is the shorter arc
/// (φ ≤ π). With a side it is the arc whose middle points to that side: if side·(A/a + B/b) < 0, the
/// longer arc is used, φ up to 2π, and L is continuous at φ = π in a plane that contains the side.
/// In space φ = π is a singularity, because the arcs in all planes have equal length; keep routings
/// away from it.
///
/// With an axis the line turns right-handed about it and its turns are counted: of all φ + 2πn the
/// value nearest to the previous one. Cylinder: the same in the plane normal to its axis, L_⊥; the
/// unrolled line is straight: L = √(L_⊥² + z²), z from A to B along the axis.
///
/// For a sphere with an axis, L is discontinuous where the plane of A, B and the centre contains the
/// axis. Keep such lines approximately normal to the axis, or use a cylinder, which has no such
/// singularity.
///
/// L is C¹ at lift-off. Ignores friction, and that a cord may slip off a sphere.
namespace sim {

using Vec3 = Eigen::Vector3d;

struct Wrap {
  double length_m = 0;                    ///< from A to B
  double wrapped_m = 0, wrapped_rad = 0;  ///< length and angle on the pulley; 0 without contact
  bool touches = false;
  Vec3 entry_m, exit_m;        ///< ends of the contact, from the centre; unset without contact
  Vec3 about = Vec3::UnitZ();  ///< axis of the wrap, right-handed
  double around_rad = 0;       ///< φ, full turns included
  bool inside = false;         ///< an end is inside the pulley; the result is the straight line
};

/// A, B and side relative to the sphere's centre, in one frame. `side` zero: the shorter arc.
Wrap wrap_sphere(const Vec3& a_m, const Vec3& b_m, double radius_m, const Vec3& side);

/// About an axis (a unit vector); `last_rad`: the previous φ.
Wrap wrap_sphere_about(const Vec3& a_m, const Vec3& b_m, double radius_m, const Vec3& axis,
                       double last_rad);
Wrap wrap_cylinder(const Vec3& a_m, const Vec3& b_m, double radius_m, const Vec3& axis,
                   double last_rad);

}  // namespace sim
