#include <algorithm>
#include <stdexcept>

#include "sim/world/bullet_inside.hpp"

namespace sim {

namespace {

/// Bullet has no products of inertia; it does not need them to integrate given velocities.
btVector3 inertia_of(const erp::Mass& mass) {
  return {mass.inertia_kg_m2[0], mass.inertia_kg_m2[1], mass.inertia_kg_m2[2]};
}

}  // namespace

BulletSkeleton::Bullet::Bullet(const RobotTree& tree_of_robot, const Vec3& g,
                               std::span<const std::string> locked_joints)
    : robot(tree_of_robot), gravity_m_per_s2(bt(g)) {
  place_bodies(locked_joints);
  for (BulletTree& tree : trees) build(tree);
  for (const erp::Joint& joint : robot.joints) joints.push_back(initial_reading(joint));
}

void BulletSkeleton::Bullet::place_bodies(std::span<const std::string> locked_joints) {
  for (const std::string& name : locked_joints)
    if (std::none_of(robot.joints.begin(), robot.joints.end(),
                     [&](const erp::Joint& j) { return j.name == name; }))
      throw std::invalid_argument("cannot lock joint \"" + name +
                                  "\": the robot has no such joint");
  int first = 0;
  for (std::size_t k = 0; k < robot.bodies.size(); ++k) {
    const TreeBody& body = robot.bodies[k];
    if (body.parent < 0) {
      places.push_back({static_cast<int>(trees.size()), -1, false});
      trees.emplace_back();
      continue;
    }
    const erp::Joint& joint = robot.joints[body.joint];
    const bool locked =
        std::find(locked_joints.begin(), locked_joints.end(), joint.name) != locked_joints.end();
    if (joint.type == erp::JointType::free && !locked) {
      places.push_back({static_cast<int>(trees.size()), -1, false, first});
      trees.emplace_back().floating = static_cast<int>(k);
      first += coordinates_of(joint.type);
      continue;
    }
    BulletTree& tree = trees[places[body.parent].tree];
    places.push_back(
        {places[body.parent].tree, static_cast<int>(tree.links.size()), locked, first});
    tree.links.push_back(static_cast<int>(k));
    if (!locked) first += coordinates_of(joint.type);
  }
}

void BulletSkeleton::Bullet::build(BulletTree& tree) {
  const int links = static_cast<int>(tree.links.size());
  if (tree.floating < 0) {
    tree.body = std::make_unique<btMultiBody>(links, 0, btVector3(0, 0, 0), true, false);
  } else {
    const erp::Mass& mass = robot.bodies[tree.floating].mass;
    tree.body = std::make_unique<btMultiBody>(links, mass.mass_kg, inertia_of(mass), false, false);
  }
  for (int link = 0; link < links; ++link) add_link(tree, link, tree.links[link]);
  btMultiBody& b = *tree.body;
  b.finalizeMultiDof();
  b.setLinearDamping(0);
  b.setAngularDamping(0);
  constexpr double unlimited = 1e9;  // above every velocity and impulse of a robot
  b.setMaxCoordinateVelocity(unlimited);
  b.setMaxAppliedImpulse(unlimited);
  for (int link = 0; link < links; ++link)
    if (b.getLink(link).m_jointType == btMultibodyLink::eRevolute)
      b.setJointPos(link, robot.joints[robot.bodies[tree.links[link]].joint].initial_rad);
}

void BulletSkeleton::Bullet::add_link(BulletTree& tree, int link, int index) {
  const TreeBody& body = robot.bodies[index];
  const erp::Joint& joint = robot.joints[body.joint];
  const double mass = body.mass.mass_kg;
  const btVector3 inertia = inertia_of(body.mass), com = bt(body.mass.com_m);
  const btVector3 pivot = bt(joint.at_m) - (robot.bodies[body.parent].parent < 0
                                                ? btVector3(0, 0, 0)
                                                : bt(robot.bodies[body.parent].mass.com_m));
  const int parent = places[body.parent].link;
  const btQuaternion identity = btQuaternion::getIdentity();
  const btVector3 axis = bt(joint.axis).normalized();
  if (joint.type == erp::JointType::revolute && !places[index].locked)
    tree.body->setupRevolute(link, mass, inertia, parent, identity, axis, pivot, com);
  else if (joint.type == erp::JointType::spherical && !places[index].locked)
    tree.body->setupSpherical(link, mass, inertia, parent, identity, pivot, com);
  else
    tree.body->setupFixed(
        link, mass, inertia, parent,
        joint.type == erp::JointType::revolute ? btQuaternion(axis, -joint.initial_rad) : identity,
        pivot, com);
}

}  // namespace sim
