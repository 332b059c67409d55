#include "sim/world/bullet_skeleton.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include "sim/world/bullet_headers.hpp"
#include "sim/world/joint_rows.hpp"

namespace sim {

namespace {

btVector3 bt(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
btVector3 bt(const xml::Vec3& v) { return {v[0], v[1], v[2]}; }
Vec3 vec(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

/// One tree: its multibody, and the rows of its joints.
struct Tree {
  std::unique_ptr<btMultiBody> body;
  JointRows rows{{}, 0};
  std::vector<int> links;  ///< body index of each link
  std::vector<JointLimit> limits;
  Eigen::MatrixXd inverse_inertia;
  Eigen::VectorXd velocity;
  Eigen::VectorXd velocity_before;  ///< at the start of the step
};

/// Where a body lives in Bullet.
struct Place {
  int tree = 0, link = -1;  ///< link −1: the fixed base
  bool locked = false;
};

}  // namespace

/// Bullet's world with our joint rows between its forces and its motion.
struct BulletSkeleton::Bullet {
  class World : public btMultiBodyDynamicsWorld {
   public:
    World(Bullet& owner)
        : btMultiBodyDynamicsWorld(&owner.dispatcher, &owner.broadphase, &owner.solver,
                                   &owner.configuration),
          owner_(owner) {}
    void solveInternalConstraints(btContactSolverInfo& info) override {
      btMultiBodyDynamicsWorld::solveInternalConstraints(info);
      for (Tree& tree : owner_.trees) {
        owner_.correct(tree, info.m_timeStep);
        owner_.rub(tree, info.m_timeStep);
      }
    }

   private:
    Bullet& owner_;
  };

  Bullet(const RobotTree& robot, const Vec3& gravity, std::span<const std::string> lock);
  ~Bullet() {
    for (Tree& tree : trees) world.removeMultiBody(tree.body.get());
  }

  void place_bodies(std::span<const std::string> lock);
  void build(Tree& tree, int index);
  void add_link(Tree& tree, int link, int body);
  void read();
  void read_pose(int body);
  void read_joint(int body);
  void correct(Tree& tree, double dt);
  void rub(Tree& tree, double dt);
  void find_limits(Tree& tree, double dt);
  void invert_inertia(Tree& tree);

  RobotTree robot;
  Vec3 gravity;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btMultiBodyConstraintSolver solver;
  std::vector<Tree> trees;
  World world{*this};
  std::vector<Place> places;  ///< of the bodies
  std::vector<BodyPose> poses;
  std::vector<BodyTwist> twists;
  std::vector<Vec3> coms;  ///< world
  std::vector<JointReading> joints;
  std::vector<btScalar> unit, response;
  btAlignedObjectArray<btScalar> scratch_r;
  btAlignedObjectArray<btVector3> scratch_v;
  btAlignedObjectArray<btMatrix3x3> scratch_m;
};

BulletSkeleton::Bullet::Bullet(const RobotTree& tree_of_robot, const Vec3& g,
                               std::span<const std::string> lock)
    : robot(tree_of_robot), gravity(g) {
  world.setGravity(bt(g));
  place_bodies(lock);
  for (std::size_t k = 0; k < trees.size(); ++k) build(trees[k], static_cast<int>(k));
  poses.resize(robot.bodies.size());
  twists.resize(robot.bodies.size());
  coms.resize(robot.bodies.size());
  joints.resize(robot.joints.size());
  read();
}

void BulletSkeleton::Bullet::place_bodies(std::span<const std::string> lock) {
  for (const std::string& name : lock)
    if (std::none_of(robot.joints.begin(), robot.joints.end(),
                     [&](const erp::Joint& j) { return j.name == name; }))
      throw std::invalid_argument("cannot lock joint \"" + name + "\": the robot has none such");
  for (std::size_t k = 0; k < robot.bodies.size(); ++k) {
    const TreeBody& body = robot.bodies[k];
    if (body.parent < 0) {
      places.push_back({static_cast<int>(trees.size()), -1, false});
      trees.emplace_back();
      continue;
    }
    Tree& tree = trees[places[body.parent].tree];
    const std::string& joint = robot.joints[body.joint].name;
    const bool locked = std::find(lock.begin(), lock.end(), joint) != lock.end();
    places.push_back({places[body.parent].tree, static_cast<int>(tree.links.size()), locked});
    tree.links.push_back(static_cast<int>(k));
  }
}

void BulletSkeleton::Bullet::build(Tree& tree, int) {
  const int links = static_cast<int>(tree.links.size());
  tree.body = std::make_unique<btMultiBody>(links, 0, btVector3(0, 0, 0), true, false);
  for (int link = 0; link < links; ++link) add_link(tree, link, tree.links[link]);
  btMultiBody& b = *tree.body;
  b.finalizeMultiDof();
  b.setLinearDamping(0);
  b.setAngularDamping(0);
  b.setMaxCoordinateVelocity(1e9);
  b.setMaxAppliedImpulse(1e9);
  std::vector<JointFriction> frictions;
  for (int link = 0; link < links; ++link) {
    const erp::Joint& joint = robot.joints[robot.bodies[tree.links[link]].joint];
    const btMultibodyLink& l = b.getLink(link);
    if (l.m_dofCount > 0 && (joint.viscous_Nm_s_per_rad > 0 || joint.coulomb_Nm > 0))
      frictions.push_back(
          {l.m_dofOffset, l.m_dofCount, joint.viscous_Nm_s_per_rad, joint.coulomb_Nm});
    if (l.m_jointType == btMultibodyLink::eRevolute) b.setJointPos(link, joint.initial_rad);
  }
  const int n = b.getNumDofs();
  tree.rows = JointRows(std::move(frictions), n);
  tree.limits.reserve(static_cast<std::size_t>(2 * n));
  tree.inverse_inertia.resize(n, n);
  tree.velocity.resize(n);
  const auto size = static_cast<std::size_t>(6 + n);
  if (unit.size() < size) unit.resize(size), response.resize(size);
  if (links > 0) world.addMultiBody(&b);
}

void BulletSkeleton::Bullet::add_link(Tree& tree, int link, int index) {
  const TreeBody& body = robot.bodies[index];
  const erp::Joint& joint = robot.joints[body.joint];
  const btVector3 inertia = bt(body.body.inertia_kg_m2), com = bt(body.body.com_m);
  const btVector3 pivot = bt(joint.at_m) - (robot.bodies[body.parent].parent < 0
                                                ? btVector3(0, 0, 0)
                                                : bt(robot.bodies[body.parent].body.com_m));
  const int parent = places[body.parent].link;
  const btQuaternion same = btQuaternion::getIdentity();
  const btVector3 axis = bt(joint.axis).normalized();
  if (joint.type == erp::JointType::revolute && !places[index].locked)
    tree.body->setupRevolute(link, body.body.mass_kg, inertia, parent, same, axis, pivot, com);
  else if (joint.type == erp::JointType::spherical && !places[index].locked)
    tree.body->setupSpherical(link, body.body.mass_kg, inertia, parent, same, pivot, com);
  else
    tree.body->setupFixed(link, body.body.mass_kg, inertia, parent,
                          joint.type == erp::JointType::revolute
                              ? btQuaternion(axis, -joint.initial_rad)
                              : same,
                          pivot, com);
}

// ---- reading ----

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

// ---- friction and limits ----

void BulletSkeleton::Bullet::find_limits(Tree& tree, double dt) {
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

void BulletSkeleton::Bullet::invert_inertia(Tree& tree) {
  const int n = tree.body->getNumDofs();
  std::fill(unit.begin(), unit.end(), 0.0);
  for (int d = 0; d < n; ++d) {
    unit[6 + d] = 1;
    tree.body->calcAccelerationDeltasMultiDof(unit.data(), response.data(), scratch_r, scratch_v);
    unit[6 + d] = 0;
    tree.inverse_inertia.col(d) = Eigen::Map<const Eigen::VectorXd>(response.data() + 6, n);
  }
}

void BulletSkeleton::Bullet::correct(Tree& tree, double dt) {
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

void BulletSkeleton::Bullet::rub(Tree& tree, double dt) {
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

// ---- BulletSkeleton ----

BulletSkeleton::BulletSkeleton(const RobotTree& tree, const Vec3& gravity,
                               std::span<const std::string> lock)
    : bullet_(std::make_unique<Bullet>(tree, gravity, lock)) {}

BulletSkeleton::~BulletSkeleton() = default;

std::span<const BodyPose> BulletSkeleton::poses() const { return bullet_->poses; }
std::span<const BodyTwist> BulletSkeleton::twists() const { return bullet_->twists; }
std::span<const JointReading> BulletSkeleton::joints() const { return bullet_->joints; }

void BulletSkeleton::set_joint(int joint, const JointReading& reading) {
  for (std::size_t k = 0; k < bullet_->robot.bodies.size(); ++k) {
    const Place& place = bullet_->places[k];
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
  const Place& place = bullet_->places[body];
  if (place.link < 0) return;
  btMultiBody& b = *bullet_->trees[place.tree].body;
  b.addLinkForce(place.link, bt(force_N));  // acts at the centre of mass
  b.addLinkTorque(place.link, bt((at_m - bullet_->coms[body]).cross(force_N)));
}

void BulletSkeleton::step(double dt_s) {
  for (Tree& tree : bullet_->trees)
    tree.velocity_before = Eigen::Map<const Eigen::VectorXd>(tree.body->getVelocityVector() + 6,
                                                             tree.body->getNumDofs());
  bullet_->world.stepSimulation(dt_s, 0);
  bullet_->read();
}

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
