#pragma once
#include <memory>
#include <span>
#include <vector>

#include "sim/world/bullet_headers.hpp"
#include "sim/world/bullet_skeleton.hpp"
#include "sim/world/joint_rows.hpp"

/// The inside of BulletSkeleton; included by its own sources only.
namespace sim {

inline btVector3 bt(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline btVector3 bt(const xml::Vec3& v) { return {v[0], v[1], v[2]}; }

/// One tree: its multibody, and the rows of its joints.
struct BulletTree {
  std::unique_ptr<btMultiBody> body;
  JointRows rows{{}, 0};
  std::vector<int> links;  ///< body index of each link
  std::vector<JointLimit> limits;
  Eigen::MatrixXd inverse_inertia;
  Eigen::VectorXd velocity;
  Eigen::VectorXd velocity_before;  ///< at the start of the step
};

/// Where a body lives in Bullet.
struct BulletPlace {
  int tree = 0, link = -1;  ///< link −1: the fixed base
  bool locked = false;
};

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
      for (BulletTree& tree : owner_.trees) {
        owner_.correct(tree, info.m_timeStep);
        owner_.rub(tree, info.m_timeStep);
      }
    }

    void pull_down() {
      clearMultiBodyForces();
      applyGravity();
    }

   private:
    Bullet& owner_;
  };

  Bullet(const RobotTree& robot, const Vec3& gravity, std::span<const std::string> lock);
  ~Bullet() {
    for (BulletTree& tree : trees) world.removeMultiBody(tree.body.get());
  }

  void place_bodies(std::span<const std::string> lock);
  void build(BulletTree& tree);
  void add_link(BulletTree& tree, int link, int body);
  void read();
  void read_pose(int body);
  void read_joint(int body);
  void correct(BulletTree& tree, double dt);
  void rub(BulletTree& tree, double dt);
  void find_limits(BulletTree& tree, double dt);
  void invert_inertia(BulletTree& tree);
  std::vector<int> coordinates_of(int tree) const;
  Response respond();

  RobotTree robot;
  Vec3 gravity;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btMultiBodyConstraintSolver solver;
  std::vector<BulletTree> trees;
  World world{*this};
  std::vector<BulletPlace> places;  ///< of the bodies
  std::vector<BodyPose> poses;
  std::vector<BodyTwist> twists;
  std::vector<Vec3> coms;  ///< world
  std::vector<JointReading> joints;
  std::vector<btScalar> unit, response;
  btAlignedObjectArray<btScalar> scratch_r;
  btAlignedObjectArray<btVector3> scratch_v;
  btAlignedObjectArray<btMatrix3x3> scratch_m;
};

}  // namespace sim
