#include "sim/world/bullet_skeleton.hpp"

#include "sim/world/bullet_inside.hpp"

namespace sim {

BulletSkeleton::BulletSkeleton(const RobotTree& tree, const Vec3& gravity,
                               std::span<const std::string> lock)
    : bullet_(std::make_unique<Bullet>(tree, gravity, lock)) {}

BulletSkeleton::~BulletSkeleton() = default;

std::span<const JointReading> BulletSkeleton::joints() const { return bullet_->joints; }

void BulletSkeleton::place(std::span<const JointReading> joints) {
  for (std::size_t k = 0; k < bullet_->robot.bodies.size(); ++k) {
    const BulletPlace& place = bullet_->places[k];
    if (place.link < 0 || place.locked) continue;
    const JointReading& reading = joints[bullet_->robot.bodies[k].joint];
    btMultiBody& b = *bullet_->trees[place.tree].body;
    const auto& p = reading.position;
    const double quaternion[4] = {p[1], p[2], p[3], p[0]};
    const bool spherical = reading.type == erp::JointType::spherical;
    b.setJointPosMultiDof(place.link, spherical ? quaternion : p.data());
    b.setJointVelMultiDof(place.link, reading.velocity_rad_per_s.data());
  }
  bullet_->read();
}

void BulletSkeleton::move(const Eigen::VectorXd& v, double dt_s) {
  for (const BulletPlace& place : bullet_->places)
    if (place.link >= 0)
      bullet_->trees[place.tree].body->setJointVelMultiDof(place.link, v.data() + place.first);
  bullet_->world.stepSimulation(dt_s, 0);
  bullet_->read();
}

void BulletSkeleton::Bullet::read() {
  for (std::size_t k = 0; k < robot.bodies.size(); ++k)
    if (places[k].link >= 0) read_joint(static_cast<int>(k));
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
