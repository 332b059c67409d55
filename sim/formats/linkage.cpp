#include "sim/formats/linkage.hpp"

#include <algorithm>
#include <stdexcept>

namespace formats {
namespace {

constexpr double same_m = 1e-9, same_direction = 1e-9;

xml::Vec3 plain(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

class Builder {
 public:
  explicit Builder(Linkage linkage) : l_(std::move(linkage)) {}

  erp::Robot robot() {
    join_balls();
    drop_frames();
    erp::Robot robot;
    robot.name = l_.name;
    erp::Skeleton skeleton;
    skeleton.gravity_m_per_s2 = xml::Vec3{0, 0, -9.81};
    for (const Link& link : l_.links) skeleton.bodies.push_back(body_of(link));
    for (const Connection& joint : l_.joints) skeleton.joints.push_back(joint_of(joint));
    robot.skeletons = {skeleton};
    return robot;
  }

 private:
  Link* link(const std::string& name) {
    const auto found = std::ranges::find(l_.links, name, &Link::name);
    return found == l_.links.end() ? nullptr : &*found;
  }
  Connection* above(const std::string& link) {
    const auto found = std::ranges::find(l_.joints, link, &Connection::child);
    return found == l_.joints.end() ? nullptr : &*found;
  }
  bool massless(const std::string& name) {
    const Link* found = link(name);
    return found && found->mass_kg == 0;
  }
  void erase(const std::string& name) {
    std::erase_if(l_.joints, [&](const Connection& j) { return j.child == name; });
    std::erase_if(l_.links, [&](const Link& k) { return k.name == name; });
  }

  static bool hinge(const Connection* joint, const Vec3& axis, const Vec3& at_m) {
    return joint && joint->type == erp::JointType::revolute &&
           (joint->axis - axis).norm() < same_direction && (joint->at_m - at_m).norm() < same_m;
  }

  /// Replaces three hinges about x, y, z in series by a ball joint, beginning at the last hinge.
  void join_balls() {
    for (std::size_t k = 0; k < l_.joints.size(); ++k) {
      Connection& z = l_.joints[k];
      if (!hinge(&z, Vec3::UnitZ(), z.at_m) || !massless(z.parent)) continue;
      const Connection* y = above(z.parent);
      if (!hinge(y, Vec3::UnitY(), z.at_m) || !massless(y->parent)) continue;
      const Connection* x = above(y->parent);
      if (!hinge(x, Vec3::UnitX(), z.at_m)) continue;
      const std::string first = y->parent, second = z.parent, parent = x->parent;
      z.type = erp::JointType::spherical;
      z.parent = parent;
      if (z.name.ends_with("_z")) z.name.resize(z.name.size() - 2);
      erase(first), erase(second);
      k = 0;
    }
  }

  /// Removes links that are fixed to another and have no mass: they are frames, not bodies.
  void drop_frames() {
    for (std::size_t k = 0; k < l_.links.size();) {
      const std::string name = l_.links[k].name;
      const Connection* joint = above(name);
      if (!joint || joint->type != erp::JointType::fixed || l_.links[k].mass_kg > 0) {
        ++k;
        continue;
      }
      const std::string parent = joint->parent;
      for (Connection& other : l_.joints)
        if (other.parent == name) other.parent = parent;
      erase(name);
      k = 0;
    }
  }

  Vec3 origin(const std::string& name) {
    const Connection* joint = above(name);
    return joint ? joint->at_m : Vec3::Zero();
  }

  erp::Body body_of(const Link& link) {
    erp::Body body;
    body.name = link.name;
    if (!above(link.name)) return body;
    const Eigen::Matrix3d& i = link.inertia_kg_m2;
    body.mass_kg = link.mass_kg;
    body.com_m = plain(link.com_m - origin(link.name));
    body.inertia_kg_m2 = {i(0, 0), i(1, 1), i(2, 2)};
    body.products_kg_m2 = {i(0, 1), i(0, 2), i(1, 2)};
    return body;
  }

  erp::Joint joint_of(const Connection& joint) {
    if (!link(joint.parent) || !link(joint.child))
      throw std::invalid_argument("joint \"" + joint.name + "\" connects \"" + joint.parent +
                                  "\" and \"" + joint.child +
                                  "\"; at least one of them is not a link");
    erp::Joint own;
    own.name = joint.name, own.type = joint.type;
    own.parent = joint.parent, own.child = joint.child;
    own.at_m = plain(joint.at_m - origin(joint.parent));
    if (joint.type == erp::JointType::revolute) own.axis = plain(joint.axis.normalized());
    own.min_rad = joint.min_rad, own.max_rad = joint.max_rad;
    own.initial_rad = std::clamp(0.0, joint.min_rad, joint.max_rad);
    own.viscous_Nm_s_per_rad = joint.viscous_Nm_s_per_rad, own.coulomb_Nm = joint.coulomb_Nm;
    return own;
  }

  Linkage l_;
};

}  // namespace

erp::Robot robot_of(Linkage linkage) { return Builder(std::move(linkage)).robot(); }

std::vector<Vec3> origins_of(const erp::Robot& robot) {
  const auto bodies = robot.bodies();
  const auto joints = robot.joints();
  const auto origin = [&](const auto& self, const std::string& name) -> Vec3 {
    const auto joint = std::ranges::find(joints, name, &erp::Joint::child);
    if (joint == joints.end()) return Vec3::Zero();
    return self(self, joint->parent) + Vec3(joint->at_m[0], joint->at_m[1], joint->at_m[2]);
  };
  std::vector<Vec3> origins;
  for (const erp::Body& body : bodies) origins.push_back(origin(origin, body.name));
  return origins;
}

Eigen::Isometry3d pose_of(const std::vector<double>& v) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Vec3(v[0], v[1], v[2]);
  pose.linear() = (Eigen::AngleAxisd(v[5], Vec3::UnitZ()) * Eigen::AngleAxisd(v[4], Vec3::UnitY()) *
                   Eigen::AngleAxisd(v[3], Vec3::UnitX()))
                      .toRotationMatrix();
  return pose;
}

}  // namespace formats
