#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim/model/actuator/rope.hpp"

/// How the nodes of a rope lie on solids.
namespace sim {
namespace {

constexpr double touching_m = 1e-6;     // chosen: so near it begins a step on a solid
constexpr double inside_m = 1e-9;       // chosen: so deep it comes onto one within a step
constexpr double creep_m_per_s = 1e-4;  // v₀
constexpr double regular = 1e-8;        // of two normals that are the same
constexpr double same_way = 0.1;        // chosen: a normal nearer to the others' span adds nothing

Vec3 velocity_of(const BodyTwist& twist, const BodyPose& pose, const Vec3& at) {
  return twist.linear_m_per_s + twist.angular_rad_per_s.cross(at - pose.position_m);
}

Clearance in_world(const Solid& solid, const BodyPose& pose, const Vec3& at) {
  const Clearance own = clearance(solid, pose.rotation.transpose() * (at - pose.position_m));
  return {own.distance_m, pose.rotation * own.outwards};
}

}  // namespace

/// Which solids each node is on: those it lies on already, and the deepest it has come into.
void Rope::touch(const Surroundings& around, double dt_s, bool at_start) {
  for (std::size_t i = 1; i < segments(); ++i) {
    Node& node = nodes_[i];
    const Vec3& at = state_.nodes_m[i];
    touch(node, at, around.poses, at_start ? touching_m : -inside_m);
    if (node.on == 0) continue;
    const auto body = static_cast<std::size_t>(node.touches[0].solid->body);
    node.carried_m = start_m_[i] + dt_s * velocity_of(around.twists[body], around.poses[body], at);
  }
}

void Rope::touch(Node& node, const Vec3& at, std::span<const BodyPose> poses,
                 double nearer_m) const {
  const auto on_it = [&](const Solid& solid) {
    return std::ranges::find(node.touching(), &solid, &Touch::solid);
  };
  for (const Solid& solid : solids_) {
    const Clearance found = in_world(solid, poses[static_cast<std::size_t>(solid.body)], at);
    const double above = found.distance_m - radius_m_;
    auto touch = on_it(solid);
    if (touch == node.touching().end()) {
      if (above >= nearer_m || node.on == node.touches.size()) continue;
      touch = node.touching().begin() + static_cast<std::ptrdiff_t>(node.on++);
    }
    *touch = {&solid, found.outwards, above, touch->push_N};
  }
}

/// The way to all surfaces, Δx·n = −above, and what leads along them: one normal after the other,
/// less what those before it hold already.
void Rope::stay_outside(Node& node) {
  node.step.setZero();
  node.across.setIdentity();
  for (const Touch& touch : node.touching()) {
    const Vec3 own = node.across * touch.normal;
    const double size = own.norm();
    if (size < same_way) continue;
    const Vec3 way = own / size;
    node.step += (-touch.above_m - touch.normal.dot(node.step)) / size * way;
    node.across -= way * way.transpose();
  }
}

/// What solids give to a node's momentum, N.
Vec3 Rope::held_by_solids(std::size_t i, double dt_s) const {
  return node_kg_ / (dt_s * dt_s) * (state_.nodes_m[i] - nodes_[i].free_m) - pull_on(i);
}

/// What each solid pushes with: held = Σ N_k n_k, as nearly as can be. Their sum, N.
double Rope::press(Node& node, const Vec3& held) {
  const auto n = static_cast<Eigen::Index>(node.on);
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> normals(3, n);
  for (Eigen::Index k = 0; k < n; ++k) normals.col(k) = node.touching()[std::size_t(k)].normal;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> gram =
      normals.transpose() * normals;
  gram.diagonal().array() += regular;
  const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> pushes =
      gram.llt().solve(normals.transpose() * held);
  double sum_N = 0;
  for (std::size_t k = 0; k < node.on; ++k) {
    node.touches[k].push_N = pushes[static_cast<Eigen::Index>(k)];
    sum_N += std::max(0.0, node.touches[k].push_N);
  }
  return sum_N;
}

/// Pushes, and the drag that they make; of the solids that would hold a node back the worst lets it
/// go. True if one did.
bool Rope::rub(double dt_s, bool may_leave) {
  bool left = false;
  for (std::size_t i = 1; i < segments(); ++i) {
    Node& node = nodes_[i];
    node.drag_kg_per_s = 0;
    if (node.on == 0) continue;
    const double push_N = press(node, held_by_solids(i, dt_s));
    const double slides = (node.across * (state_.nodes_m[i] - node.carried_m)).norm() / dt_s;
    node.drag_kg_per_s = friction_ * push_N / std::max(slides, creep_m_per_s);
    const auto worst = std::ranges::min_element(node.touching(), {}, &Touch::push_N);
    if (worst->push_N >= 0 || !may_leave) continue;
    *worst = node.touches[--node.on];
    left = true;
  }
  return left;
}

/// The forces on the bones: the rope's own pull at its ends, and what the nodes that touch pass on;
/// friction goes to the first solid.
void Rope::balance(double dt_s) {
  const auto n = segments();
  const auto& x = state_.nodes_m;
  const auto way = [&](std::size_t i) { return Vec3((x[i + 1] - x[i]).stableNormalized()); };
  state_.forces.clear();
  state_.forces.push_back({ends_[0].body, x.front(), state_.tension_N.front() * way(0)});
  state_.forces.push_back({ends_[1].body, x.back(), -state_.tension_N.back() * way(n - 1)});
  for (std::size_t i = 1; i < n && dt_s > 0; ++i) {
    const Node& node = nodes_[i];
    if (node.on == 0) continue;
    Vec3 left = -held_by_solids(i, dt_s);
    for (std::size_t k = 1; k < node.on; ++k) {
      const Vec3 own = -node.touches[k].push_N * node.touches[k].normal;
      state_.forces.push_back({node.touches[k].solid->body, x[i], own});
      left -= own;
    }
    state_.forces.push_back({node.touches[0].solid->body, x[i], left});
  }
}

}  // namespace sim
