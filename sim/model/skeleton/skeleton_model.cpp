#include "sim/model/skeleton/skeleton_model.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <stdexcept>

namespace sim {
namespace {

Eigen::Matrix3d tensor(const erp::Mass& mass) {
  const auto& i = mass.inertia_kg_m2;
  Eigen::Matrix3d t;
  t << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2];
  return t;
}

}  // namespace

SkeletonModel::SkeletonModel(const RobotTree& tree, const Vec3& gravity,
                             std::span<const std::string> locked_joints)
    : tree_(tree),
      gravity_(gravity),
      link_of_(tree.bodies.size(), -1),
      first_of_(tree.joints.size(), -1),
      movers_(tree.bodies.size()),
      poses_(tree.bodies.size()),
      twists_(tree.bodies.size()) {
  for (const std::string& name : locked_joints)
    if (std::ranges::find(tree.joints, name, &erp::Joint::name) == tree.joints.end())
      throw std::invalid_argument("cannot lock joint \"" + name +
                                  "\": the robot has no joint of this name");
  axes_.resize(6, 0);
  for (std::size_t k = 0; k < tree.bodies.size(); ++k)
    if (const int joint = tree.bodies[k].joint; joint >= 0)
      add_link(static_cast<int>(k), std::ranges::count(locked_joints, tree.joints[joint].name) > 0);
  velocity_.setZero(coordinates());
  zero_velocity_.setZero(coordinates());
  std::vector<JointReading> start;
  for (const erp::Joint& joint : tree.joints) start.push_back(initial_reading(joint));
  place(start);
}

void SkeletonModel::add_link(int k, bool locked) {
  const TreeBody& body = tree_.bodies[k];
  const erp::Joint& joint = tree_.joints[body.joint];
  Link link{.body = k, .joint = body.joint, .parent = link_of_[body.parent]};
  link.first = coordinates();
  link.dofs = locked ? 0 : coordinates_of(joint.type);
  link.axis = vec(joint.axis).normalized();
  if (joint.type == erp::JointType::revolute)
    link.rotation = Eigen::AngleAxisd(joint.initial_rad, link.axis).toRotationMatrix();
  link.origin_m = vec(joint.at_m);
  link.central_kg_m2 = tensor(body.mass);
  if (link.dofs > 0) first_of_[body.joint] = link.first;
  for (int d = 0; d < link.dofs; ++d) movers_[k].push_back(link.first + d);
  std::ranges::copy(movers_[body.parent], std::back_inserter(movers_[k]));
  axes_.resize(6, link.first + link.dofs);
  link_of_[k] = static_cast<int>(links_.size());
  links_.push_back(link);
}

void SkeletonModel::set_mass(int body, const erp::Mass& mass) {
  tree_.bodies[static_cast<std::size_t>(body)].mass = mass;
  if (const int link = link_of_[static_cast<std::size_t>(body)]; link >= 0)
    links_[static_cast<std::size_t>(link)].central_kg_m2 = tensor(mass);
}

void SkeletonModel::set_rotation(Link& link, const JointReading& joint) const {
  const auto& p = joint.position;
  if (link.dofs == 1) link.rotation = Eigen::AngleAxisd(p[0], link.axis).toRotationMatrix();
  if (link.dofs >= 3)
    link.rotation = Eigen::Quaterniond(p[0], p[1], p[2], p[3]).normalized().toRotationMatrix();
  if (link.dofs == 6) link.origin_m = vec(tree_.joints[link.joint].at_m) + vec(joint.offset_m);
}

/// Computes the body's pose, its inertia in the world frame, and the columns S of its joint.
void SkeletonModel::place(Link& link) {
  const TreeBody& body = tree_.bodies[link.body];
  const BodyPose& parent = poses_[body.parent];
  BodyPose& pose = poses_[link.body];
  pose.rotation.noalias() = parent.rotation * link.rotation;
  pose.position_m = parent.position_m + parent.rotation * link.origin_m;
  if (link.dofs == 1) axes_.col(link.first) = turning(pose.rotation * link.axis, pose.position_m);
  const Vec3 com = pose.position_m + pose.rotation * vec(body.mass.com_m);
  for (int d = 0; d < 3 && link.dofs >= 3; ++d)
    axes_.col(link.first + d) =
        turning(pose.rotation.col(d), link.dofs == 6 ? com : pose.position_m);
  for (int d = 0; d < 3 && link.dofs == 6; ++d)
    axes_.col(link.first + 3 + d) = spatial(Vec3::Zero(), parent.rotation.col(d));
  link.inertia = SpatialInertia::of(body.mass.mass_kg, com, pose.rotation, link.central_kg_m2);
}

/// Spatial velocity of the link relative to its parent.
Vec6 SkeletonModel::joint_velocity(const Link& link, const Eigen::VectorXd& v) const {
  Vec6 joint_motion = Vec6::Zero();
  for (int d = 0; d < link.dofs; ++d) joint_motion += axes_.col(link.first + d) * v[link.first + d];
  return joint_motion;
}

/// Translational part of the relative velocity of a free body, along the root's axes.
Vec3 SkeletonModel::sliding_velocity(const Link& link, const Eigen::VectorXd& v) const {
  return axes_.block<3, 3>(3, link.first + 3) * v.segment<3>(link.first + 3);
}

void SkeletonModel::place(std::span<const JointReading> joints) {
  for (Link& link : links_) {
    const JointReading& joint = joints[link.joint];
    set_rotation(link, joint);
    place(link);
    for (int d = 0; d < std::min(link.dofs, 3); ++d)
      velocity_[link.first + d] = joint.velocity_rad_per_s[static_cast<std::size_t>(d)];
    if (link.dofs == 6) velocity_.segment<3>(link.first + 3) = vec(joint.slide_m_per_s);
    link.velocity = joint_velocity(link, velocity_);
    if (link.parent >= 0) link.velocity += links_[link.parent].velocity;
    const Vec3 angular = link.velocity.head<3>();
    twists_[link.body] = {angular,
                          link.velocity.tail<3>() + angular.cross(poses_[link.body].position_m)};
  }
}

/// Gravity is modelled as an upward acceleration of the world. The axes of a joint rotate with its
/// child, dS/dt = v × S; the translation axes of a free body are those of the root and constant.
void SkeletonModel::newton_euler(const Eigen::VectorXd& v, const Eigen::VectorXd* a,
                                 Eigen::VectorXd& tau) {
  for (Link& link : links_) {
    const Vec6 joint_motion = joint_velocity(link, v);
    link.motion = joint_motion;
    link.acceleration = spatial(Vec3::Zero(), -gravity_);
    if (link.parent >= 0) {
      link.motion += links_[link.parent].motion;
      link.acceleration = links_[link.parent].acceleration;
    }
    Vec6 rotating_motion = joint_motion;
    if (link.dofs == 6) rotating_motion.tail<3>() -= sliding_velocity(link, v);
    link.acceleration += cross_motion(link.motion, rotating_motion);
    if (a) link.acceleration += joint_velocity(link, *a);
    link.force =
        link.inertia * link.acceleration + cross_force(link.motion, link.inertia * link.motion);
  }
  tau.resize(coordinates());
  for (auto link = links_.rbegin(); link != links_.rend(); ++link) {
    for (int d = 0; d < link->dofs; ++d)
      tau[link->first + d] = axes_.col(link->first + d).dot(link->force);
    if (link->parent >= 0) links_[link->parent].force += link->force;
  }
}

void SkeletonModel::inertia(Eigen::MatrixXd& h) {
  h.setZero(coordinates(), coordinates());
  for (Link& link : links_) link.composite = link.inertia;
  for (auto link = links_.rbegin(); link != links_.rend(); ++link) {
    if (link->parent >= 0) links_[link->parent].composite += link->composite;
    for (int column = link->first; column < link->first + link->dofs; ++column) {
      const Vec6 force = link->composite * axes_.col(column);
      for (const int d : movers(link->body)) h(d, column) = h(column, d) = axes_.col(d).dot(force);
    }
  }
}

Eigen::VectorXd SkeletonModel::forward(const Eigen::VectorXd& tau) {
  Eigen::MatrixXd h;
  Eigen::VectorXd b;
  inertia(h);
  bias(b);
  return h.ldlt().solve(tau - b);
}

double SkeletonModel::energy_J() const {
  double energy = 0;
  for (const Link& link : links_)
    energy += 0.5 * link.velocity.dot(link.inertia * link.velocity) -
              gravity_.dot(link.inertia.moment_kg_m);
  return energy;
}

}  // namespace sim
