#include "sim/model/actuator/solid.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sim {
namespace {

Clearance from_line(const Solid& solid, const Vec3& point) {
  const Vec3 line = solid.to_m - solid.from_m;
  const double length2 = line.squaredNorm();
  const double fraction =
      length2 > 0 ? std::clamp(line.dot(point - solid.from_m) / length2, 0.0, 1.0) : 0.0;
  const Vec3 from_segment = point - solid.from_m - fraction * line;
  const double distance = from_segment.norm();
  if (distance > 0) return {distance - solid.radius_m, from_segment / distance};
  return {-solid.radius_m, length2 > 0 ? line.unitOrthogonal() : Vec3::UnitZ()};
}

Clearance from_box(const Solid& solid, const Vec3& point) {
  const Vec3 at = point - solid.from_m;
  const Vec3 over_edge = at.cwiseAbs() - solid.half_m;
  const Vec3 outside = over_edge.cwiseMax(0.0);
  const auto signs = [&](int i) { return at[i] < 0 ? -1.0 : 1.0; };
  const double distance = outside.norm();
  if (distance > 0)
    return {distance,
            Vec3(outside[0] * signs(0), outside[1] * signs(1), outside[2] * signs(2)) / distance};
  Eigen::Index nearest = 0;
  const double depth = over_edge.maxCoeff(&nearest);
  return {depth, Vec3::Unit(nearest) * signs(static_cast<int>(nearest))};
}

Solid solid_of(const erp::Sphere& s) { return {0, vec(s.at_m), vec(s.at_m), s.radius_m}; }
Solid solid_of(const erp::Capsule& c) { return {0, vec(c.from_m), vec(c.to_m), c.radius_m}; }
Solid solid_of(const erp::Box& b) {
  return {0, vec(b.at_m), vec(b.at_m), 0, Vec3(vec(b.size_m) / 2)};
}

}  // namespace

Clearance clearance(const Solid& solid, const Vec3& point) {
  return solid.half_m.isZero(0) ? from_line(solid, point) : from_box(solid, point);
}

std::vector<Solid> solids_of(const std::vector<erp::Body>& bodies,
                             const std::vector<std::string>& names) {
  std::vector<Solid> solids;
  for (const erp::Body& body : bodies)
    for (const erp::Part& part : body.parts)
      std::visit(
          [&](const auto& p) {
            if constexpr (requires { solid_of(p); }) {
              solids.push_back(solid_of(p));
              solids.back().body =
                  static_cast<int>(std::ranges::find(names, body.name) - names.begin());
            }
          },
          part);
  return solids;
}

}  // namespace sim
