#include "sim/world/bullet_skeleton.hpp"

#include "sim/world/bullet_inside.hpp"

namespace sim {

BulletSkeleton::BulletSkeleton(const RobotTree& tree, const Vec3& gravity,
                               std::span<const std::string> locked_joints)
    : bullet_(std::make_unique<Bullet>(tree, gravity, locked_joints)) {}

BulletSkeleton::~BulletSkeleton() = default;

std::span<const JointReading> BulletSkeleton::joints() const { return bullet_->joints; }

void BulletSkeleton::place(std::span<const JointReading> joints) {
  Bullet& b = *bullet_;
  for (std::size_t k = 0; k < b.robot.bodies.size(); ++k) {
    const BulletPlace& place = b.places[k];
    const int joint = b.robot.bodies[k].joint;
    if (joint < 0 || place.locked || b.robot.joints[joint].type == erp::JointType::fixed) continue;
    b.joints[joint] = joints[joint];
    if (place.link >= 0) b.place_link(place, joints[joint]);
  }
}

void BulletSkeleton::move(const Eigen::VectorXd& v, double dt_s) {
  for (const BulletPlace& place : bullet_->places)
    if (place.link >= 0)
      bullet_->trees[place.tree].body->setJointVelMultiDof(place.link, v.data() + place.first);
  for (const BulletTree& tree : bullet_->trees)
    if (tree.floating >= 0) {
      const int first = bullet_->places[tree.floating].first;
      bullet_->place_base(tree, v.segment<3>(first), v.segment<3>(first + 3));
    }
  for (const BulletTree& tree : bullet_->trees)
    if (!tree.links.empty() || tree.floating >= 0) tree.body->stepPositionsMultiDof(dt_s);
  bullet_->read();
}

void BulletSkeleton::Bullet::place_link(const BulletPlace& place, const JointReading& reading) {
  btMultiBody& b = *trees[place.tree].body;
  const auto& p = reading.position;
  const double quaternion[4] = {p[1], p[2], p[3], p[0]};
  const bool spherical = reading.type == erp::JointType::spherical;
  b.setJointPosMultiDof(place.link, spherical ? quaternion : p.data());
  b.setJointVelMultiDof(place.link, reading.velocity_rad_per_s.data());
}

/// Bullet moves a base at its centre of mass. The base is set from its reading before each step, so
/// that a restored state continues bit by bit.
void BulletSkeleton::Bullet::place_base(const BulletTree& tree, const Vec3& turning,
                                        const Vec3& sliding) {
  const JointReading& reading = reading_of(tree.floating);
  const TreeBody& body = robot.bodies[tree.floating];
  const auto& p = reading.position;
  const btQuaternion q = btQuaternion(p[1], p[2], p[3], p[0]).normalized();
  const btVector3 com = quatRotate(q, bt(body.mass.com_m));
  tree.body->setWorldToBaseRot(q.inverse());
  tree.body->setBasePos(bt(robot.joints[body.joint].at_m) + bt(reading.offset_m) + com);
  tree.body->setBaseOmega(quatRotate(q, bt(turning)));
  tree.body->setBaseVel(bt(sliding));
}

void BulletSkeleton::Bullet::read() {
  for (std::size_t k = 0; k < robot.bodies.size(); ++k)
    if (const BulletPlace& place = places[k]; place.link >= 0 && !place.locked)
      read_link(place, robot.joints[robot.bodies[k].joint], joints[robot.bodies[k].joint]);
  for (const BulletTree& tree : trees)
    if (tree.floating >= 0) read_base(tree);
}

void BulletSkeleton::Bullet::read_link(const BulletPlace& place, const erp::Joint& joint,
                                       JointReading& reading) {
  const btMultiBody& b = *trees[place.tree].body;
  const btScalar* q = b.getJointPosMultiDof(place.link);
  const btScalar* v = b.getJointVelMultiDof(place.link);
  if (joint.type == erp::JointType::revolute) {
    reading.position[0] = q[0], reading.velocity_rad_per_s[0] = v[0];
  } else if (joint.type == erp::JointType::spherical) {
    reading.position = {q[3], q[0], q[1], q[2]};
    reading.velocity_rad_per_s = {v[0], v[1], v[2]};
  }
}

void BulletSkeleton::Bullet::read_base(const BulletTree& tree) {
  JointReading& reading = reading_of(tree.floating);
  const TreeBody& body = robot.bodies[tree.floating];
  const btQuaternion q = tree.body->getWorldToBaseRot().inverse();
  const btVector3 com = quatRotate(q, bt(body.mass.com_m));
  const btVector3 offset = tree.body->getBasePos() - com - bt(robot.joints[body.joint].at_m);
  const btVector3 turning = quatRotate(q.inverse(), tree.body->getBaseOmega());
  const btVector3 sliding = tree.body->getBaseVel();
  reading.position = {q.w(), q.x(), q.y(), q.z()};
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    reading.offset_m[k] = offset[i], reading.velocity_rad_per_s[k] = turning[i];
    reading.slide_m_per_s[k] = sliding[i];
  }
}

}  // namespace sim
