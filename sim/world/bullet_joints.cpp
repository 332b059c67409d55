#include <algorithm>
#include <cmath>

#include "sim/world/bullet_inside.hpp"

namespace sim {

void BulletSkeleton::Bullet::find_limits(BulletTree& tree, double dt) {
  tree.limits.clear();
  for (std::size_t link = 0; link < tree.links.size(); ++link) {
    const btMultibodyLink& l = tree.body->getLink(static_cast<int>(link));
    const erp::Joint& joint = robot.joints[robot.bodies[tree.links[link]].joint];
    if (l.m_dofCount == 1) {
      const double q = l.m_jointPos[0], next = q + dt * tree.velocity[l.m_dofOffset];
      if (next > joint.max_rad)
        tree.limits.push_back({l.m_dofOffset, 1, Vec3::UnitX(), joint.max_rad - q});
      if (next < joint.min_rad)
        tree.limits.push_back({l.m_dofOffset, 1, -Vec3::UnitX(), q - joint.min_rad});
    } else if (l.m_dofCount == 3) {
      // Of a spherical joint max_rad bounds the whole rotation; dα/dt = axis·ω in either frame.
      const double sign = l.m_jointPos[3] < 0 ? -1 : 1;
      const Vec3 v = sign * Vec3(l.m_jointPos[0], l.m_jointPos[1], l.m_jointPos[2]);
      const double sine = v.norm(), angle = 2 * std::atan2(sine, sign * l.m_jointPos[3]);
      if (sine < 1e-9) continue;
      if (angle + dt * (v / sine).dot(tree.velocity.segment<3>(l.m_dofOffset)) > joint.max_rad)
        tree.limits.push_back({l.m_dofOffset, 3, v / sine, joint.max_rad - angle});
    }
  }
}

void BulletSkeleton::Bullet::invert_inertia(BulletTree& tree) {
  const int n = tree.body->getNumDofs();
  std::fill(unit.begin(), unit.end(), 0.0);
  for (int d = 0; d < n; ++d) {
    unit[6 + d] = 1;
    tree.body->calcAccelerationDeltasMultiDof(unit.data(), response.data(), scratch_r, scratch_v);
    unit[6 + d] = 0;
    tree.inverse_inertia.col(d) = Eigen::Map<const Eigen::VectorXd>(response.data() + 6, n);
  }
}

/// Where a tree's coordinates stand among all, in the order of the bodies: Bullet keeps each tree's
/// own together.
std::vector<int> BulletSkeleton::Bullet::coordinates_of(int tree) const {
  std::vector<int> ours;
  int next = 0;
  for (const BulletPlace& place : places) {
    if (place.link < 0) continue;
    const int dofs = trees[place.tree].body->getLink(place.link).m_dofCount;
    for (int d = 0; d < dofs; ++d, ++next)
      if (place.tree == tree) ours.push_back(next);
  }
  return ours;
}

BulletSkeleton::Response BulletSkeleton::Bullet::respond() {
  int n = 0;
  for (BulletTree& tree : trees) n += tree.body->getNumDofs();
  Response all{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  world.pull_down();
  for (std::size_t t = 0; t < trees.size(); ++t) {
    btMultiBody& b = *trees[t].body;
    const int own = b.getNumDofs();
    if (own == 0) continue;
    b.computeAccelerationsArticulatedBodyAlgorithmMultiDof(0, scratch_r, scratch_v, scratch_m,
                                                           false, false, false);
    const Eigen::VectorXd a = Eigen::Map<const Eigen::VectorXd>(&scratch_r[own] + 6, own);
    invert_inertia(trees[t]);
    const std::vector<int> ours = coordinates_of(static_cast<int>(t));
    all.inverse_inertia(ours, ours) = trees[t].inverse_inertia;
    all.acceleration(ours) = a;
  }
  world.clearMultiBodyForces();
  return all;
}

void BulletSkeleton::Bullet::correct(BulletTree& tree, double dt) {
  btMultiBody& b = *tree.body;
  const int n = b.getNumDofs();
  if (n == 0) return;
  // v⁺ = v + dt a(q, (v + v¹)/2), v¹ = v + dt a(q, v): the velocity-dependent forces at mid-step.
  Eigen::Map<Eigen::VectorXd> velocity(const_cast<btScalar*>(b.getVelocityVector()) + 6, n);
  velocity = 0.5 * (tree.velocity_before + velocity);
  b.computeAccelerationsArticulatedBodyAlgorithmMultiDof(0, scratch_r, scratch_v, scratch_m, false,
                                                         false, false);
  velocity = tree.velocity_before + dt * Eigen::Map<const Eigen::VectorXd>(&scratch_r[n] + 6, n);
}

void BulletSkeleton::Bullet::rub(BulletTree& tree, double dt) {
  const int n = tree.body->getNumDofs();
  if (n == 0) return;
  // The velocities with all forces of this step applied; Bullet's caches belong to this state.
  Eigen::Map<const Eigen::VectorXd> before(tree.body->getVelocityVector() + 6, n);
  tree.velocity = before;
  find_limits(tree, dt);
  if (!tree.rows.has_friction() && tree.limits.empty()) return;
  invert_inertia(tree);
  tree.rows.solve(tree.inverse_inertia, tree.limits, dt, tree.velocity);
  std::fill(response.begin(), response.end(), 0.0);
  for (int d = 0; d < n; ++d) response[6 + d] = tree.velocity[d] - before[d];
  tree.body->applyDeltaVeeMultiDof(response.data(), 1);
}

}  // namespace sim
