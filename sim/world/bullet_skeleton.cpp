#include "sim/world/bullet_skeleton.hpp"

#include <Eigen/Geometry>

#include "sim/world/bullet_inside.hpp"

namespace sim {

BulletSkeleton::BulletSkeleton(const RobotTree& tree, const Vec3& gravity,
                               std::span<const std::string> lock)
    : bullet_(std::make_unique<Bullet>(tree, gravity, lock)) {}

BulletSkeleton::~BulletSkeleton() = default;

std::span<const BodyPose> BulletSkeleton::poses() const { return bullet_->poses; }
std::span<const BodyTwist> BulletSkeleton::twists() const { return bullet_->twists; }
std::span<const JointReading> BulletSkeleton::joints() const { return bullet_->joints; }

void BulletSkeleton::set_joint(int joint, const JointReading& reading) {
  for (std::size_t k = 0; k < bullet_->robot.bodies.size(); ++k) {
    const BulletPlace& place = bullet_->places[k];
    if (bullet_->robot.bodies[k].joint != joint || place.locked) continue;
    btMultiBody& b = *bullet_->trees[place.tree].body;
    const auto& p = reading.position;
    const double quaternion[4] = {p[1], p[2], p[3], p[0]};
    const bool spherical = reading.type == erp::JointType::spherical;
    b.setJointPosMultiDof(place.link, spherical ? quaternion : p.data());
    b.setJointVelMultiDof(place.link, reading.velocity_rad_per_s.data());
  }
  bullet_->read();
}

void BulletSkeleton::push(int body, const Vec3& at_m, const Vec3& force_N) {
  const BulletPlace& place = bullet_->places[body];
  if (place.link < 0) return;
  btMultiBody& b = *bullet_->trees[place.tree].body;
  b.addLinkForce(place.link, bt(force_N));  // acts at the centre of mass
  b.addLinkTorque(place.link, bt((at_m - bullet_->coms[body]).cross(force_N)));
}

void BulletSkeleton::step(double dt_s) {
  for (BulletTree& tree : bullet_->trees)
    tree.velocity_before = Eigen::Map<const Eigen::VectorXd>(tree.body->getVelocityVector() + 6,
                                                             tree.body->getNumDofs());
  bullet_->world.stepSimulation(dt_s, 0);
  bullet_->read();
}

BulletSkeleton::Response BulletSkeleton::respond() { return bullet_->respond(); }

double BulletSkeleton::energy_J() const {
  double energy = 0;
  for (std::size_t k = 0; k < bullet_->robot.bodies.size(); ++k) {
    if (bullet_->places[k].link < 0) continue;
    const erp::Body& body = bullet_->robot.bodies[k].body;
    const BodyTwist& twist = bullet_->twists[k];
    const Vec3 spin = bullet_->poses[k].rotation.transpose() * twist.angular_rad_per_s;
    const Vec3 velocity =
        twist.linear_m_per_s +
        twist.angular_rad_per_s.cross(bullet_->coms[k] - bullet_->poses[k].position_m);
    const Vec3 inertia(body.inertia_kg_m2[0], body.inertia_kg_m2[1], body.inertia_kg_m2[2]);
    energy += 0.5 * body.mass_kg * velocity.squaredNorm() +
              0.5 * spin.dot(inertia.cwiseProduct(spin)) -
              body.mass_kg * bullet_->gravity.dot(bullet_->coms[k]);
  }
  return energy;
}

}  // namespace sim
