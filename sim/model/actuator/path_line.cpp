#include "sim/model/actuator/path_line.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sim {
namespace {

/// The entry point rotated about the axis of the wrap; on a cylinder also moved along the axis in
/// proportion to the angle.
void add_arc(std::vector<Vec3>& line, const PathShape& shape, std::size_t k, double step_rad) {
  const Vec3 &center = shape.pulls[k].at_m, &axis = shape.about[k];
  const Vec3 in = shape.entry_m[k] - center;
  const Vec3 along = axis.dot(in) * axis;
  const Vec3 rise = axis.dot(shape.exit_m[k] - shape.entry_m[k]) * axis;
  const int steps = 1 + static_cast<int>(shape.wrapped_rad[k] / step_rad);
  for (int i = 0; i <= steps; ++i) {
    const double fraction = static_cast<double>(i) / steps;
    const Eigen::AngleAxisd turn(fraction * shape.wrapped_rad[k], axis);
    line.push_back(center + along + turn * (in - along) + fraction * rise);
  }
}

}  // namespace

std::vector<Vec3> path_line(const Routing& routing, const PathShape& shape, double arc_step_rad) {
  std::vector<Vec3> line;
  for (std::size_t k = 0; k < routing.elements().size(); ++k) {
    if (routing.elements()[k].radius_m == 0) line.push_back(shape.entry_m[k]);
    else if (shape.touches[k]) add_arc(line, shape, k, arc_step_rad);
  }
  return line;
}

Vec3 point_on_line(std::span<const Vec3> line, double fraction) {
  double length_m = 0;
  for (std::size_t i = 1; i < line.size(); ++i) length_m += (line[i] - line[i - 1]).norm();
  double remaining_m = fraction * length_m;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double step_m = (line[i] - line[i - 1]).norm();
    if (remaining_m <= step_m && step_m > 0)
      return line[i - 1] + remaining_m / step_m * (line[i] - line[i - 1]);
    remaining_m -= step_m;
  }
  return line.back();
}

}  // namespace sim
