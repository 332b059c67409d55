#pragma once
#include <span>
#include <vector>

#include "sim/model/actuator/routing.hpp"

/// A tendon's path as a polyline, for pictures and for the initial shape of a rope.
namespace sim {

/// In the world frame; arcs are divided into steps of at most `arc_step_rad`.
std::vector<Vec3> path_line(const Routing& routing, const PathShape& shape, double arc_step_rad);

/// The point at a fraction, 0 … 1, of the line's length.
Vec3 point_on_line(std::span<const Vec3> line, double fraction);

}  // namespace sim
