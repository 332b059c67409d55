#include "sim/actuator/routing.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

namespace sim {

namespace {

Vec3 vec(const xml::Vec3& v) { return {v[0], v[1], v[2]}; }

int index_of(const std::string& body, std::span<const std::string> names) {
  const auto found = std::find(names.begin(), names.end(), body);
  if (found == names.end())
    throw std::invalid_argument("a tendon is attached to body \"" + body + "\", which is unknown");
  return static_cast<int>(found - names.begin());
}

}  // namespace

Routing::Routing(const erp::Tendon& tendon, std::span<const std::string> names) {
  for (const auto& element : tendon.path) {
    if (const auto* attach = std::get_if<erp::Attach>(&element)) {
      elements_.push_back({index_of(attach->body, names), vec(attach->at_m), 0, Vec3::Zero()});
    } else {
      const auto& pulley = std::get<erp::Pulley>(element);
      if (!(pulley.radius_m > 0)) throw std::invalid_argument("pulley radius_m must be positive");
      elements_.push_back(
          {index_of(pulley.body, names), vec(pulley.center_m), pulley.radius_m, vec(pulley.side)});
    }
  }
  if (elements_.size() < 2 || elements_.size() > max_path_elements)
    throw std::invalid_argument("a tendon's path has 2 to " + std::to_string(max_path_elements) +
                                " elements, got " + std::to_string(elements_.size()));
  if (elements_.front().radius_m > 0 || elements_.back().radius_m > 0)
    throw std::invalid_argument("a tendon's path begins and ends with <attach>");
}

PathShape Routing::solve(std::span<const BodyPose> poses) const {
  PathShape shape;
  solve(poses, shape);
  return shape;
}

void Routing::solve(std::span<const BodyPose> poses, PathShape& shape) const {
  shape.length_m = 0;
  shape.elements = static_cast<int>(elements_.size());
  place(shape, poses);
  for (int first = 0, k = 1; k < shape.elements; ++k) {
    if (elements_[k].radius_m > 0) continue;
    if (k > first + 1) wrap_between(shape, poses, first, k);
    first = k;
  }
  pull(shape);
}

void Routing::require_outside(std::span<const BodyPose> poses) const {
  const PathShape shape = solve(poses);
  for (int k = 0; k < shape.elements; ++k)
    if (shape.inside[k])
      throw std::invalid_argument("element " + std::to_string(k + 1) +
                                  " of the path: a neighbouring point lies inside this pulley");
}

void Routing::place(PathShape& shape, std::span<const BodyPose> poses) const {
  for (int k = 0; k < shape.elements; ++k) {
    const BodyPose& pose = poses[elements_[k].body];
    const Vec3 at = pose.position_m + pose.rotation * elements_[k].at_m;
    shape.pulls[k] = {elements_[k].body, at, Vec3::Zero()};
    shape.entry_m[k] = shape.exit_m[k] = at;
    shape.touches[k] = elements_[k].radius_m == 0;
    shape.inside[k] = false;
    shape.wrapped_rad[k] = 0;
  }
}

void Routing::wrap_between(PathShape& shape, std::span<const BodyPose> poses, int first,
                           int last) const {
  // Gauss–Seidel: each pulley between its neighbours' tangent points, until none moves.
  const bool single = last == first + 2;
  for (int turn = 0; turn < 200; ++turn) {
    double moved = 0;
    for (int k = first + 1; k < last; ++k) moved = std::max(moved, wrap_one(shape, poses, k));
    if (single || moved < 1e-15) break;
  }
}

double Routing::wrap_one(PathShape& shape, std::span<const BodyPose> poses, int k) const {
  int before = k - 1, after = k + 1;
  while (!shape.touches[before]) --before;
  while (!shape.touches[after]) ++after;
  const PathElement& pulley = elements_[k];
  const Vec3& center = shape.pulls[k].at_m;
  const SphereWrap wrap = wrap_sphere(shape.exit_m[before] - center, shape.entry_m[after] - center,
                                      pulley.radius_m, poses[pulley.body].rotation * pulley.side);
  const Vec3 entry = wrap.touches ? Vec3(center + wrap.entry_m) : center;
  const Vec3 exit = wrap.touches ? Vec3(center + wrap.exit_m) : center;
  const double moved = std::max((entry - shape.entry_m[k]).lpNorm<Eigen::Infinity>(),
                                (exit - shape.exit_m[k]).lpNorm<Eigen::Infinity>());
  shape.entry_m[k] = entry;
  shape.exit_m[k] = exit;
  shape.touches[k] = wrap.touches;
  shape.wrapped_rad[k] = wrap.angle_rad;
  shape.inside[k] = wrap.inside;
  return moved;
}

void Routing::pull(PathShape& shape) const {
  int last = 0;
  for (int k = 1; k < shape.elements; ++k) {
    if (!shape.touches[k]) continue;
    const Vec3 span = shape.entry_m[k] - shape.exit_m[last];
    const double length = span.norm();
    const Vec3 along = length > 0 ? Vec3(span / length) : Vec3::Zero();
    shape.pulls[last].direction += along;
    shape.pulls[k].direction -= along;
    shape.length_m += length + elements_[k].radius_m * shape.wrapped_rad[k];
    last = k;
  }
}

double length_rate_m_per_s(const PathShape& shape, std::span<const BodyPose> poses,
                           std::span<const BodyTwist> twists) {
  double rate = 0;
  for (const PathPull& pull : shape.pulled()) {
    const BodyTwist& twist = twists[pull.body];
    const Vec3 arm = pull.at_m - poses[pull.body].position_m;
    rate -= pull.direction.dot(twist.linear_m_per_s + twist.angular_rad_per_s.cross(arm));
  }
  return rate;
}

}  // namespace sim
