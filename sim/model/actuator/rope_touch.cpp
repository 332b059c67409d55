#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim/model/actuator/rope.hpp"

/// Contacts between the nodes of a rope and solids.
namespace sim {
namespace {

constexpr double contact_distance_m = 1e-6;  // chosen: distance of a contact at the start of a step
constexpr double contact_depth_m = 1e-9;     // chosen: depth of a new contact during a step
constexpr double creep_m_per_s = 1e-4;       // v₀
constexpr double gram_regularization =
    1e-8;  // chosen: keeps the Gram matrix of equal normals invertible
constexpr double min_independent_normal = 0.1;  // chosen: a normal with a smaller part
                                                // outside the span of the others is ignored

Vec3 velocity_of(const BodyTwist& twist, const BodyPose& pose, const Vec3& at) {
  return twist.linear_m_per_s + twist.angular_rad_per_s.cross(at - pose.position_m);
}

Clearance in_world(const Solid& solid, const BodyPose& pose, const Vec3& at) {
  const Clearance in_body = clearance(solid, pose.rotation.transpose() * (at - pose.position_m));
  return {in_body.distance_m, pose.rotation * in_body.outwards};
}

}  // namespace

/// Updates the contacts of each node: existing contacts, and new ones with sufficient depth.
void Rope::touch(const Surroundings& around, double dt_s, bool at_start) {
  for (std::size_t i = 1; i < segments(); ++i) {
    Node& node = nodes_[i];
    const Vec3& at = state_.nodes_m[i];
    touch(node, at, around.poses, at_start ? contact_distance_m : -contact_depth_m);
    if (node.contact_count == 0) continue;
    const auto body = static_cast<std::size_t>(node.touches[0].solid->body);
    node.carried_m = start_m_[i] + dt_s * velocity_of(around.twists[body], around.poses[body], at);
  }
}

void Rope::touch(Node& node, const Vec3& at, std::span<const BodyPose> poses,
                 double new_contact_m) const {
  const auto contact_with = [&](const Solid& solid) {
    return std::ranges::find(node.touching(), &solid, &Touch::solid);
  };
  for (const Solid& solid : solids_) {
    const Clearance clear = in_world(solid, poses[static_cast<std::size_t>(solid.body)], at);
    const double above = clear.distance_m - radius_m_;
    auto touch = contact_with(solid);
    if (touch == node.touching().end()) {
      if (above >= new_contact_m || node.contact_count == node.touches.size()) continue;
      touch = node.touching().begin() + static_cast<std::ptrdiff_t>(node.contact_count++);
    }
    *touch = {&solid, clear.outwards, above, touch->push_N};
  }
}

/// Computes the step to all surfaces, Δx·n = −distance, and the projection onto them, by
/// orthogonalising the normals one after the other.
void Rope::stay_outside(Node& node) {
  node.step.setZero();
  node.projection.setIdentity();
  for (const Touch& touch : node.touching()) {
    const Vec3 independent = node.projection * touch.normal;
    const double size = independent.norm();
    if (size < min_independent_normal) continue;
    const Vec3 direction = independent / size;
    node.step += (-touch.distance_m - touch.normal.dot(node.step)) / size * direction;
    node.projection -= direction * direction.transpose();
  }
}

/// Contact force on a node, from its momentum balance, N.
Vec3 Rope::contact_force(std::size_t i, double dt_s) const {
  return node_kg_ / (dt_s * dt_s) * (state_.nodes_m[i] - nodes_[i].free_m) - tension_force(i);
}

/// Distributes the contact force to the solids by least squares, F = Σ N_k n_k. Returns Σ N_k, N.
double Rope::distribute_contact_force(Node& node, const Vec3& force_N) {
  const auto n = static_cast<Eigen::Index>(node.contact_count);
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> normals(3, n);
  for (Eigen::Index k = 0; k < n; ++k) normals.col(k) = node.touching()[std::size_t(k)].normal;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> gram =
      normals.transpose() * normals;
  gram.diagonal().array() += gram_regularization;
  const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> pushes =
      gram.llt().solve(normals.transpose() * force_N);
  double sum_N = 0;
  for (std::size_t k = 0; k < node.contact_count; ++k) {
    node.touches[k].push_N = pushes[static_cast<Eigen::Index>(k)];
    sum_N += std::max(0.0, node.touches[k].push_N);
  }
  return sum_N;
}

/// Updates contact forces and friction drag. Releases, for each node, the contact with the most
/// negative force. Returns true if a contact was released.
bool Rope::update_contacts(double dt_s, bool may_release) {
  bool released = false;
  for (std::size_t i = 1; i < segments(); ++i) {
    Node& node = nodes_[i];
    node.drag_kg_per_s = 0;
    if (node.contact_count == 0) continue;
    const double push_N = distribute_contact_force(node, contact_force(i, dt_s));
    const double slip_speed_m_per_s =
        (node.projection * (state_.nodes_m[i] - node.carried_m)).norm() / dt_s;
    node.drag_kg_per_s = friction_ * push_N / std::max(slip_speed_m_per_s, creep_m_per_s);
    const auto worst = std::ranges::min_element(node.touching(), {}, &Touch::push_N);
    if (worst->push_N >= 0 || !may_release) continue;
    *worst = node.touches[--node.contact_count];
    released = true;
  }
  return released;
}

/// Computes the forces on the bones: tension at the ends, and contact forces of the nodes. Friction
/// acts on the first solid of a node.
void Rope::update_bone_forces(double dt_s) {
  const auto n = segments();
  const auto& x = state_.nodes_m;
  const auto direction = [&](std::size_t i) { return Vec3((x[i + 1] - x[i]).stableNormalized()); };
  state_.forces.clear();
  state_.forces.push_back({ends_[0].body, x.front(), state_.tension_N.front() * direction(0)});
  state_.forces.push_back({ends_[1].body, x.back(), -state_.tension_N.back() * direction(n - 1)});
  for (std::size_t i = 1; i < n && dt_s > 0; ++i) {
    const Node& node = nodes_[i];
    if (node.contact_count == 0) continue;
    Vec3 remaining = -contact_force(i, dt_s);
    for (std::size_t k = 1; k < node.contact_count; ++k) {
      const Vec3 force = -node.touches[k].push_N * node.touches[k].normal;
      state_.forces.push_back({node.touches[k].solid->body, x[i], force});
      remaining -= force;
    }
    state_.forces.push_back({node.touches[0].solid->body, x[i], remaining});
  }
}

}  // namespace sim
