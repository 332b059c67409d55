#pragma once
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/model/skeleton/pose.hpp"

/// Distance of a point from the solids of bodies.
namespace sim {

/// A capsule, that is all points within `radius_m` of a line segment (a sphere has a segment of length
/// 0), or a box.
struct Solid {
  int body = 0;
  Vec3 from_m = Vec3::Zero(), to_m = Vec3::Zero();  ///< body frame; both are the centre of a box
  double radius_m = 0;
  Vec3 half_m = Vec3::Zero();  ///< half the edge lengths of a box; zero for a capsule
};

/// Distance from the surface, negative inside, and the outward direction; body frame.
struct Clearance {
  double distance_m;
  Vec3 outwards;
};
Clearance clearance(const Solid& solid, const Vec3& point_m);

/// The solids of all bodies.
std::vector<Solid> solids_of(const std::vector<erp::Body>& bodies,
                             const std::vector<std::string>& body_names);

}  // namespace sim
