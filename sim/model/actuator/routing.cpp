#include "sim/model/actuator/routing.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <stdexcept>

namespace sim {

namespace {

constexpr int max_iterations = 200;         // chosen
constexpr double converged_step_m = 1e-15;  // rounding of positions of about 1 m

int index_of(const std::string& body, std::span<const std::string> names) {
  const auto position = std::find(names.begin(), names.end(), body);
  if (position == names.end())
    throw std::invalid_argument("a tendon is attached to body \"" + body +
                                "\", which the robot does not have");
  return static_cast<int>(position - names.begin());
}

PathElement element_of(const erp::Pulley& pulley, std::span<const std::string> names) {
  if (!(pulley.radius_m > 0)) throw std::invalid_argument("pulley radius_m must be positive");
  PathElement element{index_of(pulley.body, names), vec(pulley.center_m), pulley.radius_m,
                      vec(pulley.side)};
  element.cylinder = pulley.shape == erp::PulleyShape::cylinder;
  if (pulley.axis) element.axis = vec(*pulley.axis).normalized();
  if (element.cylinder && !pulley.axis)
    throw std::invalid_argument("a cylindrical pulley needs an axis");
  element.turns = pulley.turns;
  return element;
}

Wrap wrapped(const PathElement& pulley, const Eigen::Matrix3d& body_rotation, const Vec3& a,
             const Vec3& b, double last_rad) {
  const double r = pulley.radius_m;
  if (pulley.axis.isZero(0)) return wrap_sphere(a, b, r, body_rotation * pulley.side);
  const Vec3 axis = body_rotation * pulley.axis;
  return pulley.cylinder ? wrap_cylinder(a, b, r, axis, last_rad)
                         : wrap_sphere_about(a, b, r, axis, last_rad);
}

}  // namespace

Routing::Routing(const erp::Tendon& tendon, std::span<const std::string> names) {
  for (const auto& element : tendon.path) {
    if (const auto* attach = std::get_if<erp::Attach>(&element)) {
      elements_.push_back({index_of(attach->body, names), vec(attach->at_m), 0, Vec3::Zero()});
    } else {
      elements_.push_back(element_of(std::get<erp::Pulley>(element), names));
    }
  }
  if (elements_.size() < 2 || elements_.size() > max_path_elements)
    throw std::invalid_argument("a tendon's path must have 2 to " +
                                std::to_string(max_path_elements) + " elements, got " +
                                std::to_string(elements_.size()));
  if (elements_.front().radius_m > 0 || elements_.back().radius_m > 0)
    throw std::invalid_argument("a tendon's path must begin and end with <attach>");
}

PathShape Routing::solve(std::span<const BodyPose> poses) const {
  PathShape shape;
  for (std::size_t k = 0; k < elements_.size(); ++k)  // initial value: the middle of the given turn
    shape.around_rad[k] = std::numbers::pi * (1 + 2 * elements_[k].turns);
  solve(poses, shape);
  return shape;
}

void Routing::solve(std::span<const BodyPose> poses, PathShape& shape) const {
  shape.length_m = 0;
  shape.elements = static_cast<int>(elements_.size());
  const auto last_rad = shape.around_rad;
  place(shape, poses);
  for (int first = 0, k = 1; k < shape.elements; ++k) {
    if (elements_[k].radius_m > 0) continue;
    if (k > first + 1) wrap_between(shape, poses, last_rad, first, k);
    first = k;
  }
  pull(shape);
}

void Routing::require_outside(std::span<const BodyPose> poses) const {
  if (const int k = solve(poses).penetrated_pulley(); k >= 0)
    throw std::invalid_argument(
        "element " + std::to_string(k + 1) +
        " of the path is a pulley that contains a neighbouring point; move the point outside");
}

int PathShape::penetrated_pulley() const {
  for (int k = 0; k < elements; ++k)
    if (inside[k]) return k;
  return -1;
}

void Routing::place(PathShape& shape, std::span<const BodyPose> poses) const {
  for (int k = 0; k < shape.elements; ++k) {
    const BodyPose& pose = poses[elements_[k].body];
    const Vec3 at = pose.position_m + pose.rotation * elements_[k].at_m;
    shape.pulls[k] = {elements_[k].body, at, Vec3::Zero(), Vec3::Zero()};
    shape.entry_m[k] = shape.exit_m[k] = at;
    shape.touches[k] = elements_[k].radius_m == 0;
    shape.inside[k] = false;
    shape.wrapped_rad[k] = shape.wrapped_m[k] = 0;
  }
}

void Routing::wrap_between(PathShape& shape, std::span<const BodyPose> poses,
                           std::span<const double> last_rad, int first, int last) const {
  // Gauss–Seidel: each pulley between the tangent points of its neighbours, until convergence.
  const bool single = last == first + 2;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    double moved_m = 0;
    for (int k = first + 1; k < last; ++k)
      moved_m = std::max(moved_m, wrap_one(shape, poses, last_rad[static_cast<std::size_t>(k)], k));
    if (single || moved_m < converged_step_m) break;
  }
}

double Routing::wrap_one(PathShape& shape, std::span<const BodyPose> poses, double last_rad,
                         int k) const {
  int before = k - 1, after = k + 1;
  while (!shape.touches[before]) --before;
  while (!shape.touches[after]) ++after;
  const PathElement& pulley = elements_[k];
  const Vec3& center = shape.pulls[k].at_m;
  const Wrap wrap = wrapped(pulley, poses[pulley.body].rotation, shape.exit_m[before] - center,
                            shape.entry_m[after] - center, last_rad);
  const Vec3 entry = wrap.touches ? Vec3(center + wrap.entry_m) : center;
  const Vec3 exit = wrap.touches ? Vec3(center + wrap.exit_m) : center;
  const double moved_m = std::max((entry - shape.entry_m[k]).lpNorm<Eigen::Infinity>(),
                                  (exit - shape.exit_m[k]).lpNorm<Eigen::Infinity>());
  shape.entry_m[k] = entry;
  shape.exit_m[k] = exit;
  shape.touches[k] = wrap.touches;
  shape.wrapped_rad[k] = wrap.wrapped_rad;
  shape.wrapped_m[k] = wrap.wrapped_m;
  shape.around_rad[k] = wrap.around_rad;
  shape.about[k] = wrap.about;
  shape.inside[k] = wrap.inside;
  return moved_m;
}

void Routing::pull(PathShape& shape) const {
  int last = 0;
  const auto add = [&](int k, const Vec3& at, const Vec3& along) {
    PathPull& pull = shape.pulls[k];
    pull.direction += along;
    if (elements_[k].cylinder) pull.moment_m += (at - pull.at_m).cross(along);
  };
  for (int k = 1; k < shape.elements; ++k) {
    if (!shape.touches[k]) continue;
    const Vec3 span = shape.entry_m[k] - shape.exit_m[last];
    const double length = span.norm();
    const Vec3 along = length > 0 ? Vec3(span / length) : Vec3::Zero();
    add(last, shape.exit_m[last], along);
    add(k, shape.entry_m[k], -along);
    shape.length_m += length + shape.wrapped_m[k];
    last = k;
  }
}

double bend_rad(const PathShape& shape) {
  double sum = 0;
  for (std::size_t k = 1; k + 1 < static_cast<std::size_t>(shape.elements); ++k) {
    const double half_sine = std::min(1.0, shape.pulls[k].direction.norm() / 2);
    sum += shape.wrapped_rad[k] > 0 ? shape.wrapped_rad[k] : 2 * std::asin(half_sine);
  }
  return sum;
}

double length_rate_m_per_s(const PathShape& shape, std::span<const BodyPose> poses,
                           std::span<const BodyTwist> twists) {
  double rate = 0;
  for (const PathPull& pull : shape.pulled()) {
    const BodyTwist& twist = twists[pull.body];
    const Vec3 arm = pull.at_m - poses[pull.body].position_m;
    rate -= pull.direction.dot(twist.linear_m_per_s + twist.angular_rad_per_s.cross(arm)) +
            pull.moment_m.dot(twist.angular_rad_per_s);
  }
  return rate;
}

}  // namespace sim
