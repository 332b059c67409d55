#pragma once
#include <span>
#include <vector>

#include "sim/model/actuator/routing.hpp"

/// A tendon's path as a line through points, for pictures and for laying a rope.
namespace sim {

/// World; arcs in steps of at most `arc_step_rad`.
std::vector<Vec3> path_line(const Routing& routing, const PathShape& shape, double arc_step_rad);

/// The point at a share 0 … 1 of the line's length.
Vec3 along_line(std::span<const Vec3> line, double share);

}  // namespace sim
