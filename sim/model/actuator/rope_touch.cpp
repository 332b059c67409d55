#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim/model/actuator/rope.hpp"

/// Contacts between the nodes of a rope and solids.
namespace sim {
namespace {

constexpr double touching_m = 1e-6;     // chosen: distance of a contact at the start of a step
constexpr double inside_m = 1e-9;       // chosen: depth of a new contact during a step
constexpr double creep_m_per_s = 1e-4;  // v₀
constexpr double regular = 1e-8;        // regularises equal normals
constexpr double same_way = 0.1;  // chosen: a normal nearer to the span of the others is ignored

Vec3 velocity_of(const BodyTwist& twist, const BodyPose& pose, const Vec3& at) {
  return twist.linear_m_per_s + twist.angular_rad_per_s.cross(at - pose.position_m);
}

Clearance in_world(const Solid& solid, const BodyPose& pose, const Vec3& at) {
  const Clearance own = clearance(solid, pose.rotation.transpose() * (at - pose.position_m));
  return {own.distance_m, pose.rotation * own.outwards};
}

}  // namespace

/// Updates the contacts of each node: existing contacts, and new ones with sufficient depth.
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

/// Computes the step to all surfaces, Δx·n = −above, and the projection onto them, by orthogonalising
/// the normals one after the other.
void Rope::stay_outside(Node& node) {
  node.step.setZero();
  node.across.setIdentity();
  for (const Touch& touch : node.touching()) {
    const Vec3 own = node.across * touch.normal;
    const double size = own.norm();
    if (size < same_way) continue;
    const Vec3 direction = own / size;
    node.step += (-touch.above_m - touch.normal.dot(node.step)) / size * direction;
    node.across -= direction * direction.transpose();
  }
}

/// Contact force on a node, from its momentum balance, N.
Vec3 Rope::contact_force(std::size_t i, double dt_s) const {
  return node_kg_ / (dt_s * dt_s) * (state_.nodes_m[i] - nodes_[i].free_m) - pull_on(i);
}

/// Distributes the contact force to the solids by least squares, held = Σ N_k n_k. Returns Σ N_k, N.
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

/// Updates contact forces and friction drag. Releases, for each node, the contact with the most negative
/// force. Returns true if a contact was released.
bool Rope::update_contacts(double dt_s, bool may_release) {
  bool released = false;
  for (std::size_t i = 1; i < segments(); ++i) {
    Node& node = nodes_[i];
    node.drag_kg_per_s = 0;
    if (node.on == 0) continue;
    const double push_N = press(node, contact_force(i, dt_s));
    const double slides = (node.across * (state_.nodes_m[i] - node.carried_m)).norm() / dt_s;
    node.drag_kg_per_s = friction_ * push_N / std::max(slides, creep_m_per_s);
    const auto worst = std::ranges::min_element(node.touching(), {}, &Touch::push_N);
    if (worst->push_N >= 0 || !may_release) continue;
    *worst = node.touches[--node.on];
    released = true;
  }
  return released;
}

/// Computes the forces on the bones: tension at the ends, and contact forces of the nodes. Friction acts
/// on the first solid of a node.
void Rope::balance(double dt_s) {
  const auto n = segments();
  const auto& x = state_.nodes_m;
  const auto direction = [&](std::size_t i) { return Vec3((x[i + 1] - x[i]).stableNormalized()); };
  state_.forces.clear();
  state_.forces.push_back({ends_[0].body, x.front(), state_.tension_N.front() * direction(0)});
  state_.forces.push_back({ends_[1].body, x.back(), -state_.tension_N.back() * direction(n - 1)});
  for (std::size_t i = 1; i < n && dt_s > 0; ++i) {
    const Node& node = nodes_[i];
    if (node.on == 0) continue;
    Vec3 remaining = -contact_force(i, dt_s);
    for (std::size_t k = 1; k < node.on; ++k) {
      const Vec3 own = -node.touches[k].push_N * node.touches[k].normal;
      state_.forces.push_back({node.touches[k].solid->body, x[i], own});
      remaining -= own;
    }
    state_.forces.push_back({node.touches[0].solid->body, x[i], remaining});
  }
}

}  // namespace sim
