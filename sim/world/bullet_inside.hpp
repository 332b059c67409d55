#pragma once
#include <memory>
#include <span>
#include <vector>

#include "sim/world/bullet_headers.hpp"
#include "sim/world/bullet_skeleton.hpp"

/// Implementation of BulletSkeleton; included only by the sources of BulletSkeleton.
namespace sim {

/// One tree: its multibody and the body index of each link. The base is a root or a free body.
struct BulletTree {
  std::unique_ptr<btMultiBody> body;
  std::vector<int> links;
  int floating = -1;  ///< index of the free body; −1: the base is fixed
};

/// Position of a body in Bullet, and the first coordinate of its joint in v.
struct BulletPlace {
  int tree = 0, link = -1;  ///< link −1: the base
  bool locked = false;
  int first = 0;
};

struct BulletSkeleton::Bullet {
  Bullet(const RobotTree& robot, const Vec3& gravity, std::span<const std::string> locked_joints);

  void place_bodies(std::span<const std::string> locked_joints);
  void build(BulletTree& tree);
  void add_link(BulletTree& tree, int link, int body);
  void place_link(const BulletPlace& place, const JointReading& reading);
  void place_base(const BulletTree& tree, const Vec3& turning_rad_per_s,
                  const Vec3& sliding_m_per_s);
  void read();
  void read_link(const BulletPlace& place, const erp::Joint& joint, JointReading& reading);
  void read_base(const BulletTree& tree);
  JointReading& reading_of(int body) {
    return joints[static_cast<std::size_t>(robot.bodies[body].joint)];
  }
  void respond(const BulletTree& tree, Response& all);

  RobotTree robot;
  btVector3 gravity_m_per_s2;
  std::vector<BulletTree> trees;
  std::vector<BulletPlace> places;  ///< one per body
  std::vector<JointReading> joints;
};

}  // namespace sim
