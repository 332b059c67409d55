#include "sim/actuator/sphere_wrap.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace sim {

namespace {

/// One end, seen from the centre: its direction, and the tangent from it to the sphere.
struct End {
  Vec3 direction;
  double tangent_m;  ///< √(a² − r²)
  double angle_rad;  ///< α
  bool inside;
};

End look_at(const Vec3& point, double r) {
  const double distance = point.norm(), above = std::max(distance - r, 0.0);
  const double tangent = std::sqrt(above * (above + 2 * r));
  const Vec3 direction = distance > 0 ? Vec3(point / distance) : Vec3::UnitZ();
  return {direction, tangent, std::atan2(tangent, r), distance < r};
}

/// The way from A to B: the angle, and the axis about which it is positive.
struct Way {
  Vec3 axis;
  double angle_rad;
};

Way choose_way(const Vec3& a, const Vec3& b, const Vec3& side) {
  const Vec3 cross = a.cross(b);
  const double sine = cross.norm();
  const double angle = std::atan2(sine, a.dot(b));
  if (sine < 1e-12) {  // in line with the centre: the side, or any direction, gives the plane
    const Vec3 across = a.cross(side);
    const bool long_way = a.dot(b) > 0 && side.dot(a) < 0;
    return {across.norm() > 1e-9 ? across.normalized() : a.unitOrthogonal(),
            long_way ? 2 * std::numbers::pi : angle};
  }
  if (side.dot(a + b) < 0) return {-cross / sine, 2 * std::numbers::pi - angle};
  return {cross / sine, angle};
}

/// The point of the sphere at `angle` from `direction`, turning about `axis`.
Vec3 on_sphere(double r, const Vec3& direction, const Vec3& axis, double angle) {
  return r * (std::cos(angle) * direction + std::sin(angle) * axis.cross(direction));
}

}  // namespace

SphereWrap wrap_sphere(const Vec3& a, const Vec3& b, double r, const Vec3& side) {
  const End from = look_at(a, r), to = look_at(b, r);
  const Way way = choose_way(from.direction, to.direction, side);
  const double wrapped = way.angle_rad - from.angle_rad - to.angle_rad;
  SphereWrap result;
  result.inside = from.inside || to.inside;
  if (result.inside || !(wrapped > 0)) {
    result.length_m = (b - a).norm();
    return result;
  }
  result.touches = true;
  result.angle_rad = wrapped;
  result.length_m = from.tangent_m + to.tangent_m + r * wrapped;
  result.entry_m = on_sphere(r, from.direction, way.axis, from.angle_rad);
  result.exit_m = on_sphere(r, to.direction, way.axis, -to.angle_rad);
  return result;
}

}  // namespace sim
