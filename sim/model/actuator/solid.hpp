#pragma once
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/model/skeleton/pose.hpp"

/// How far a point is from the solids that bodies consist of.
namespace sim {

/// All points within `radius_m` of a line (a sphere has a line of no length), or a box.
struct Solid {
  int body = 0;
  Vec3 from_m = Vec3::Zero(), to_m = Vec3::Zero();  ///< body frame; of a box: its centre, both
  double radius_m = 0;
  Vec3 half_m = Vec3::Zero();  ///< of a box: half its edges; zero otherwise
};

/// Distance from the surface, negative inside, and the way out; body frame.
struct Clearance {
  double distance_m;
  Vec3 outwards;
};
Clearance clearance(const Solid& solid, const Vec3& point_m);

/// Of all bodies.
std::vector<Solid> solids_of(const std::vector<erp::Body>& bodies,
                             const std::vector<std::string>& body_names);

}  // namespace sim
