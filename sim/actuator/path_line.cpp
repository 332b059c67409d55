#include "sim/actuator/path_line.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sim {
namespace {

/// e cos φ + t sin φ from where the line comes in, t the way it comes; along a cylinder as far as
/// it has turned.
void add_arc(std::vector<Vec3>& line, const PathShape& shape, std::size_t k,
             const Vec3& cylinder_axis, double step_rad) {
  const Vec3& center = shape.pulls[k].at_m;
  const double angle = shape.wrapped_rad[k];
  Vec3 arm = shape.entry_m[k] - center;
  const bool cylinder = !cylinder_axis.isZero(0);
  const Vec3 axis =
      cylinder ? cylinder_axis : Vec3(arm.cross(shape.entry_m[k] - line.back()).normalized());
  const Vec3 base = center + axis.dot(arm) * axis;
  const Vec3 rise = axis.dot(shape.exit_m[k] - shape.entry_m[k]) * axis;
  arm = shape.entry_m[k] - base;
  const int steps = 1 + static_cast<int>(angle / step_rad);
  for (int i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    line.push_back(base + Eigen::AngleAxisd(share * angle, axis) * arm + share * rise);
  }
}

}  // namespace

std::vector<Vec3> path_line(const Routing& routing, const PathShape& shape,
                            std::span<const BodyPose> poses, double arc_step_rad) {
  std::vector<Vec3> line;
  const auto elements = routing.elements();
  for (std::size_t k = 0; k < elements.size(); ++k) {
    const PathElement& element = elements[k];
    const auto body = static_cast<std::size_t>(element.body);
    const Vec3 axis =
        element.cylinder ? Vec3(poses[body].rotation * element.axis) : Vec3(Vec3::Zero());
    if (element.radius_m == 0) line.push_back(shape.entry_m[k]);
    else if (shape.touches[k]) add_arc(line, shape, k, axis, arc_step_rad);
  }
  return line;
}

Vec3 along_line(std::span<const Vec3> line, double share) {
  double length = 0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  double left = share * length;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double step = (line[i] - line[i - 1]).norm();
    if (left <= step && step > 0) return line[i - 1] + left / step * (line[i] - line[i - 1]);
    left -= step;
  }
  return line.back();
}

}  // namespace sim
