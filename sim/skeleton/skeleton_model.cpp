#include "sim/skeleton/skeleton_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

namespace sim {
namespace {

Vec3 vec(const xml::Vec3& v) { return {v[0], v[1], v[2]}; }

}  // namespace

SkeletonModel::SkeletonModel(const RobotTree& tree, const Vec3& gravity,
                             std::span<const std::string> lock)
    : tree_(tree),
      gravity_(gravity),
      link_of_(tree.bodies.size(), -1),
      first_of_(tree.joints.size(), -1),
      poses_(tree.bodies.size()),
      twists_(tree.bodies.size()) {
  for (const std::string& name : lock)
    if (std::ranges::find(tree.joints, name, &erp::Joint::name) == tree.joints.end())
      throw std::invalid_argument("cannot lock joint \"" + name + "\": the robot has none such");
  for (std::size_t k = 0; k < tree.bodies.size(); ++k)
    if (const int joint = tree.bodies[k].joint; joint >= 0)
      add_link(static_cast<int>(k), std::ranges::count(lock, tree.joints[joint].name) > 0);
  std::vector<JointReading> start(tree.joints.size());
  for (std::size_t j = 0; j < start.size(); ++j) {
    start[j].type = tree.joints[j].type;
    start[j].position[0] =
        start[j].type == erp::JointType::spherical ? 1 : tree.joints[j].initial_rad;
  }
  place(start);
}

void SkeletonModel::add_link(int k, bool locked) {
  const TreeBody& body = tree_.bodies[k];
  const erp::Joint& joint = tree_.joints[body.joint];
  Link link{.body = k, .joint = body.joint, .parent = link_of_[body.parent]};
  link.first = coordinates_;
  link.placement.at_m = vec(joint.at_m);
  link.inertia =
      spatial_inertia(body.body.mass_kg, vec(body.body.com_m), vec(body.body.inertia_kg_m2));
  if (joint.type == erp::JointType::revolute && !locked) {
    link.subspace = spatial(vec(joint.axis).normalized(), Vec3::Zero());
  } else if (joint.type == erp::JointType::spherical && !locked) {
    link.subspace = Mat6::Identity().leftCols<3>();
  } else {
    link.subspace.resize(6, 0);
    if (joint.type == erp::JointType::revolute)
      link.placement.rotation =
          Eigen::AngleAxisd(joint.initial_rad, vec(joint.axis).normalized()).toRotationMatrix();
  }
  link.dofs = static_cast<int>(link.subspace.cols());
  if (link.dofs > 0) first_of_[body.joint] = link.first;
  coordinates_ += link.dofs;
  link_of_[k] = static_cast<int>(links_.size());
  links_.push_back(link);
}

void SkeletonModel::turn(Link& link, const JointReading& joint) const {
  const auto& p = joint.position;
  if (link.dofs == 1)
    link.placement.rotation =
        Eigen::AngleAxisd(p[0], Vec3(link.subspace.col(0).head<3>())).toRotationMatrix();
  if (link.dofs == 3)
    link.placement.rotation =
        Eigen::Quaterniond(p[0], p[1], p[2], p[3]).normalized().toRotationMatrix();
}

void SkeletonModel::place(std::span<const JointReading> joints) {
  for (Link& link : links_) {
    const JointReading& joint = joints[link.joint];
    turn(link, joint);
    const BodyPose& parent = poses_[tree_.bodies[link.body].parent];
    poses_[link.body] = {parent.rotation * link.placement.rotation,
                         parent.position_m + parent.rotation * link.placement.at_m};
    const Vec6 before = link.parent < 0 ? Vec6(Vec6::Zero()) : links_[link.parent].velocity;
    link.velocity = link.placement.motion_to_child(before);
    for (int d = 0; d < link.dofs; ++d)
      link.velocity += link.subspace.col(d) * joint.velocity_rad_per_s[d];
    const auto& rotation = poses_[link.body].rotation;
    twists_[link.body] = {rotation * link.velocity.head<3>(), rotation * link.velocity.tail<3>()};
  }
}

void SkeletonModel::gather_velocity(std::span<const JointReading> joints,
                                    Eigen::VectorXd& v) const {
  v.resize(coordinates_);
  for (const Link& link : links_)
    for (int d = 0; d < link.dofs; ++d)
      v[link.first + d] = joints[link.joint].velocity_rad_per_s[static_cast<std::size_t>(d)];
}

/// Gravity is the world falling upwards. What a joint's own speed adds to its acceleration as the
/// child's frame sees it is v × S q̇ = v × (v − X v_parent).
void SkeletonModel::newton_euler(const Eigen::VectorXd* a, bool moving, Eigen::VectorXd& tau) {
  const Vec6 world = spatial(Vec3::Zero(), -gravity_);
  for (Link& link : links_) {
    const bool hangs = link.parent >= 0;
    link.acceleration =
        link.placement.motion_to_child(hangs ? links_[link.parent].acceleration : world);
    if (a && link.dofs > 0) link.acceleration += link.subspace * a->segment(link.first, link.dofs);
    link.force = link.inertia * link.acceleration;
    if (!moving) continue;
    const Vec6 carried =
        link.placement.motion_to_child(hangs ? links_[link.parent].velocity : Vec6(Vec6::Zero()));
    const Vec6 extra = cross_motion(link.velocity, link.velocity - carried);
    link.acceleration += extra;
    link.force += link.inertia * extra + cross_force(link.velocity, link.inertia * link.velocity);
  }
  tau.resize(coordinates_);
  for (auto link = links_.rbegin(); link != links_.rend(); ++link) {
    if (link->dofs > 0)
      tau.segment(link->first, link->dofs) = link->subspace.transpose() * link->force;
    if (link->parent >= 0)
      links_[link->parent].force += link->placement.force_to_parent(link->force);
  }
}

void SkeletonModel::inertia(Eigen::MatrixXd& h) {
  h.setZero(coordinates_, coordinates_);
  for (Link& link : links_) link.composite = link.inertia;
  for (auto link = links_.rbegin(); link != links_.rend(); ++link) {
    if (link->parent >= 0) {
      const Mat6 x = link->placement.matrix();
      links_[link->parent].composite += x.transpose() * link->composite * x;
    }
    for (int d = 0; d < link->dofs; ++d) {
      const int column = link->first + d;
      Vec6 force = link->composite * link->subspace.col(d);
      for (const Link* on = &*link;; on = &links_[on->parent]) {
        for (int e = 0; e < on->dofs; ++e)
          h(on->first + e, column) = h(column, on->first + e) = on->subspace.col(e).dot(force);
        if (on->parent < 0) break;
        force = on->placement.force_to_parent(force);
      }
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

void SkeletonModel::add_torques(int body, const Vec3& at_m, const Vec3& force_N,
                                Eigen::VectorXd& tau) const {
  for (int k = link_of_[body]; k >= 0; k = links_[k].parent) {
    const Link& link = links_[k];
    const BodyPose& pose = poses_[link.body];
    const Vec3 moment = pose.rotation.transpose() * (at_m - pose.position_m).cross(force_N);
    const Vec6 wrench = spatial(moment, pose.rotation.transpose() * force_N);
    for (int d = 0; d < link.dofs; ++d) tau[link.first + d] += link.subspace.col(d).dot(wrench);
  }
}

double SkeletonModel::energy_J() const {
  double energy = 0;
  for (const Link& link : links_) {
    const erp::Body& body = tree_.bodies[link.body].body;
    const BodyPose& pose = poses_[link.body];
    energy += 0.5 * link.velocity.dot(link.inertia * link.velocity) -
              body.mass_kg * gravity_.dot(pose.position_m + pose.rotation * vec(body.com_m));
  }
  return energy;
}

}  // namespace sim
