#include <algorithm>

#include "sim/world/bullet_inside.hpp"

// The result of Bullet's articulated-body algorithm.
namespace sim {

void BulletSkeleton::Bullet::respond(const BulletTree& tree, Response& all) {
  btMultiBody& b = *tree.body;
  const int n = b.getNumDofs();
  b.clearForcesAndTorques();
  for (int link = 0; link < b.getNumLinks(); ++link)
    b.addLinkForce(link, gravity_m_per_s2 * b.getLinkMass(link));
  btAlignedObjectArray<btScalar> scratch_r;
  btAlignedObjectArray<btVector3> scratch_v;
  btAlignedObjectArray<btMatrix3x3> scratch_m;
  b.computeAccelerationsArticulatedBodyAlgorithmMultiDof(0, scratch_r, scratch_v, scratch_m, false,
                                                         false, false);
  std::vector<int> coordinates;  // indices of the tree's coordinates among all
  for (const int body : tree.links)
    for (int d = 0; d < b.getLink(places[body].link).m_dofCount; ++d)
      coordinates.push_back(places[body].first + d);
  for (int d = 0; d < n; ++d) all.acceleration[coordinates[d]] = scratch_r[n + 6 + d];
  std::vector<btScalar> unit(static_cast<std::size_t>(6 + n)), response(unit.size());
  for (int d = 0; d < n; ++d) {
    std::fill(unit.begin(), unit.end(), 0.0);
    unit[static_cast<std::size_t>(6 + d)] = 1;
    b.calcAccelerationDeltasMultiDof(unit.data(), response.data(), scratch_r, scratch_v);
    for (int e = 0; e < n; ++e)
      all.inverse_inertia(coordinates[e], coordinates[d]) =
          response[static_cast<std::size_t>(6 + e)];
  }
}

BulletSkeleton::Response BulletSkeleton::respond() {
  int n = 0;
  for (const BulletTree& tree : bullet_->trees) n += tree.body->getNumDofs();
  Response all{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), {}};
  for (const BulletTree& tree : bullet_->trees)
    if (tree.body->getNumDofs() > 0) bullet_->respond(tree, all);
  for (const BulletPlace& place : bullet_->places) {
    const btVector3 at = place.link < 0 ? btVector3(0, 0, 0)
                                        : bullet_->trees[place.tree].body->localPosToWorld(
                                              place.link, btVector3(0, 0, 0));
    all.com_m.emplace_back(at.x(), at.y(), at.z());
  }
  return all;
}

}  // namespace sim
