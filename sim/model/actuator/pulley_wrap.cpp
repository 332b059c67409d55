#include "sim/model/actuator/pulley_wrap.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace sim {

namespace {

constexpr double collinear_sine = 1e-12;  // chosen: A, B and the centre lie on a line
constexpr double parallel_norm = 1e-9;    // chosen: the side is parallel to A

/// One end relative to the centre: its direction, and the tangent from it to the sphere.
struct TangentEnd {
  Vec3 direction;
  double tangent_m;  ///< √(a² − r²)
  double angle_rad;  ///< α
  bool inside;
};

TangentEnd tangent_end(const Vec3& point, double r) {
  const double distance = point.norm(), above = std::max(distance - r, 0.0);
  const double tangent = std::sqrt(above * (above + 2 * r));
  const Vec3 direction = distance > 0 ? Vec3(point / distance) : Vec3::UnitZ();
  return {direction, tangent, std::atan2(tangent, r), distance < r};
}

/// The arc from A to B: the angle, and the axis about which it is positive.
struct Arc {
  Vec3 axis;
  double angle_rad;
};

Arc choose_arc(const Vec3& a, const Vec3& b, const Vec3& side) {
  const Vec3 cross = a.cross(b);
  const double sine = cross.norm();
  const double angle = std::atan2(sine, a.dot(b));
  if (sine < collinear_sine) {  // the plane follows from the side, or is arbitrary
    const Vec3 across = a.cross(side);
    const bool is_full_turn = a.dot(b) > 0 && side.dot(a) < 0;
    return {across.norm() > parallel_norm ? across.normalized() : a.unitOrthogonal(),
            is_full_turn ? 2 * std::numbers::pi : angle};
  }
  if (side.dot(a + b) < 0) return {-cross / sine, 2 * std::numbers::pi - angle};
  return {cross / sine, angle};
}

/// The arc that is right-handed about an axis, with the number of turns nearest to `last_rad`.
Arc arc_about(const Vec3& a, const Vec3& b, const Vec3& axis, double last_rad) {
  constexpr double turn = 2 * std::numbers::pi;
  const Vec3 cross = a.cross(b);
  const double sine = cross.norm(), angle = std::atan2(sine, a.dot(b));
  const bool is_forward = sine < collinear_sine || cross.dot(axis) >= 0;
  const Vec3 normal = sine < collinear_sine ? axis : Vec3((is_forward ? 1 : -1) / sine * cross);
  const double within_one_turn = is_forward ? angle : turn - angle;
  return {normal, within_one_turn + turn * std::ceil((last_rad - within_one_turn) / turn -
                                                     0.5)};  // for equal distance, the fewer turns
}

/// The point of the sphere at `angle` from `direction`, turning about `axis`.
Vec3 on_sphere(double r, const Vec3& direction, const Vec3& axis, double angle) {
  return r * (std::cos(angle) * direction + std::sin(angle) * axis.cross(direction));
}

/// The wrap around the sphere or circle along this arc.
Wrap wrap_around(const Vec3& a, const Vec3& b, double r, const TangentEnd& from,
                 const TangentEnd& to, const Arc& arc) {
  const double angle = arc.angle_rad - from.angle_rad - to.angle_rad;
  Wrap result;
  result.around_rad = arc.angle_rad;
  result.about = arc.axis;
  result.inside = from.inside || to.inside;
  if (result.inside || !(angle > 0)) {
    result.length_m = (b - a).norm();
    return result;
  }
  result.touches = true;
  result.wrapped_rad = angle;
  result.wrapped_m = r * angle;
  result.length_m = from.tangent_m + to.tangent_m + result.wrapped_m;
  result.entry_m = on_sphere(r, from.direction, arc.axis, from.angle_rad);
  result.exit_m = on_sphere(r, to.direction, arc.axis, -to.angle_rad);
  return result;
}

}  // namespace

Wrap wrap_sphere(const Vec3& a, const Vec3& b, double r, const Vec3& side) {
  const TangentEnd from = tangent_end(a, r), to = tangent_end(b, r);
  return wrap_around(a, b, r, from, to, choose_arc(from.direction, to.direction, side));
}

Wrap wrap_sphere_about(const Vec3& a, const Vec3& b, double r, const Vec3& axis, double last_rad) {
  const TangentEnd from = tangent_end(a, r), to = tangent_end(b, r);
  return wrap_around(a, b, r, from, to, arc_about(from.direction, to.direction, axis, last_rad));
}

Wrap wrap_cylinder(const Vec3& a, const Vec3& b, double r, const Vec3& axis, double last_rad) {
  const double start = a.dot(axis), rise = b.dot(axis) - start;
  const Vec3 across_a = a - start * axis, across_b = b - (start + rise) * axis;
  const TangentEnd from = tangent_end(across_a, r), to = tangent_end(across_b, r);
  Wrap wrap = wrap_around(across_a, across_b, r, from, to,
                          arc_about(from.direction, to.direction, axis, last_rad));
  if (wrap.touches) {  // axial offset in proportion to the length of the unrolled line
    const double slope = rise / wrap.length_m;
    wrap.entry_m += (start + slope * from.tangent_m) * axis;
    wrap.exit_m += (start + rise - slope * to.tangent_m) * axis;
    wrap.wrapped_m *= std::sqrt(1 + slope * slope);
  }
  wrap.length_m = std::hypot(wrap.length_m, rise);
  return wrap;
}

}  // namespace sim
