#include <Eigen/Geometry>

#include "sim/world/bullet_inside.hpp"

namespace sim {

namespace {
Vec3 vec(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
}  // namespace

void BulletSkeleton::Bullet::read() {
  for (std::size_t k = 0; k < robot.bodies.size(); ++k) {
    if (places[k].link < 0) continue;  // a root rests at the world's origin
    read_pose(static_cast<int>(k));
    read_joint(static_cast<int>(k));
  }
}

void BulletSkeleton::Bullet::read_pose(int k) {
  const TreeBody& body = robot.bodies[k];
  const btMultiBody& b = *trees[places[k].tree].body;
  const btMultibodyLink& link = b.getLink(places[k].link);
  const BodyPose& parent = poses[body.parent];
  const BodyTwist& parent_twist = twists[body.parent];
  const btQuaternion& q = link.m_cachedRotParentToThis;  // parent to child
  const Eigen::Matrix3d turn =
      Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized().toRotationMatrix().transpose();
  const xml::Vec3& at = robot.joints[body.joint].at_m;
  const Vec3 arm = parent.rotation * Vec3(at[0], at[1], at[2]);
  poses[k] = {parent.rotation * turn, parent.position_m + arm};
  Vec3 spin = Vec3::Zero();
  const btScalar* speed = b.getJointVelMultiDof(places[k].link);
  for (int d = 0; d < link.m_dofCount; ++d) spin += vec(link.getAxisTop(d)) * speed[d];
  twists[k] = {parent_twist.angular_rad_per_s + poses[k].rotation * spin,
               parent_twist.linear_m_per_s + parent_twist.angular_rad_per_s.cross(arm)};
  const xml::Vec3& com = body.body.com_m;
  coms[k] = poses[k].position_m + poses[k].rotation * Vec3(com[0], com[1], com[2]);
}

void BulletSkeleton::Bullet::read_joint(int k) {
  const int index = robot.bodies[k].joint;
  const erp::Joint& joint = robot.joints[index];
  JointReading& reading = joints[index];
  reading.type = joint.type;
  if (places[k].locked || joint.type == erp::JointType::fixed) {
    reading.position = {joint.type == erp::JointType::spherical ? 1.0 : joint.initial_rad, 0, 0, 0};
    return;
  }
  const btMultiBody& b = *trees[places[k].tree].body;
  const btScalar* q = b.getJointPosMultiDof(places[k].link);
  const btScalar* v = b.getJointVelMultiDof(places[k].link);
  if (joint.type == erp::JointType::revolute) {
    reading.position[0] = q[0], reading.velocity_rad_per_s[0] = v[0];
  } else {
    reading.position = {q[3], q[0], q[1], q[2]};
    reading.velocity_rad_per_s = {v[0], v[1], v[2]};
  }
}

}  // namespace sim
