#include "sim/formats/linkage.hpp"

#include <algorithm>
#include <stdexcept>

namespace formats {
namespace {

constexpr double same_m = 1e-9, same_direction = 1e-9;  // chosen: rounding

xml::Vec3 array_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

class Builder {
 public:
  explicit Builder(Linkage linkage) : linkage_(std::move(linkage)) {}

  erp::Robot robot() {
    join_balls();
    drop_frames();
    erp::Robot robot;
    robot.name = linkage_.name;
    erp::Skeleton skeleton;
    skeleton.gravity_m_per_s2 = xml::Vec3{0, 0, -9.81};
    for (const Link& link : linkage_.links) skeleton.bodies.push_back(body_of(link));
    for (const Connection& joint : linkage_.joints) skeleton.joints.push_back(joint_of(joint));
    robot.skeletons = {skeleton};
    return robot;
  }

 private:
  Link* find_link(const std::string& name) {
    const auto match = std::ranges::find(linkage_.links, name, &Link::name);
    return match == linkage_.links.end() ? nullptr : &*match;
  }
  Connection* parent_joint(const std::string& link) {
    const auto match = std::ranges::find(linkage_.joints, link, &Connection::child);
    return match == linkage_.joints.end() ? nullptr : &*match;
  }
  bool is_massless(const std::string& name) {
    const Link* match = find_link(name);
    return match && match->mass_kg == 0;
  }
  void erase(const std::string& name) {
    std::erase_if(linkage_.joints, [&](const Connection& j) { return j.child == name; });
    std::erase_if(linkage_.links, [&](const Link& k) { return k.name == name; });
  }

  static bool is_hinge(const Connection* joint, const Vec3& axis, const Vec3& at_m) {
    return joint && joint->type == erp::JointType::revolute &&
           (joint->axis - axis).norm() < same_direction && (joint->at_m - at_m).norm() < same_m;
  }

  /// Replaces three hinges about x, y, z in series by a ball joint, beginning at the last hinge.
  void join_balls() {
    for (std::size_t k = 0; k < linkage_.joints.size(); ++k) {
      Connection& z = linkage_.joints[k];
      if (!is_hinge(&z, Vec3::UnitZ(), z.at_m) || !is_massless(z.parent)) continue;
      const Connection* y = parent_joint(z.parent);
      if (!is_hinge(y, Vec3::UnitY(), z.at_m) || !is_massless(y->parent)) continue;
      const Connection* x = parent_joint(y->parent);
      if (!is_hinge(x, Vec3::UnitX(), z.at_m)) continue;
      const std::string first = y->parent, second = z.parent, parent = x->parent;
      z.type = erp::JointType::spherical;
      z.parent = parent;
      if (z.name.ends_with("_z")) z.name.resize(z.name.size() - 2);
      erase(first), erase(second);
      k = 0;
    }
  }

  /// Removes links without mass that are fixed to another link. They are frames, not bodies.
  void drop_frames() {
    for (std::size_t k = 0; k < linkage_.links.size();) {
      const std::string name = linkage_.links[k].name;
      const Connection* joint = parent_joint(name);
      if (!joint || joint->type != erp::JointType::fixed || linkage_.links[k].mass_kg > 0) {
        ++k;
        continue;
      }
      const std::string parent = joint->parent;
      for (Connection& other : linkage_.joints)
        if (other.parent == name) other.parent = parent;
      erase(name);
      k = 0;
    }
  }

  Vec3 origin(const std::string& name) {
    const Connection* joint = parent_joint(name);
    return joint ? joint->at_m : Vec3::Zero();
  }

  erp::Body body_of(const Link& link) {
    erp::Body body;
    body.name = link.name;
    if (!parent_joint(link.name)) return body;
    const Eigen::Matrix3d& i = link.inertia_kg_m2;
    body.mass_kg = link.mass_kg;
    body.com_m = array_of(link.com_m - origin(link.name));
    body.inertia_kg_m2 = {i(0, 0), i(1, 1), i(2, 2)};
    body.products_kg_m2 = {i(0, 1), i(0, 2), i(1, 2)};
    return body;
  }

  erp::Joint joint_of(const Connection& joint) {
    if (!find_link(joint.parent) || !find_link(joint.child))
      throw std::invalid_argument("joint \"" + joint.name + "\" connects \"" + joint.parent +
                                  "\" and \"" + joint.child +
                                  "\"; at least one of them is not a link");
    erp::Joint result;
    result.name = joint.name, result.type = joint.type;
    result.parent = joint.parent, result.child = joint.child;
    result.at_m = array_of(joint.at_m - origin(joint.parent));
    if (joint.type == erp::JointType::revolute) result.axis = array_of(joint.axis.normalized());
    result.min_rad = joint.min_rad, result.max_rad = joint.max_rad;
    result.initial_rad = std::clamp(0.0, joint.min_rad, joint.max_rad);
    result.viscous_Nm_s_per_rad = joint.viscous_Nm_s_per_rad, result.coulomb_Nm = joint.coulomb_Nm;
    return result;
  }

  Linkage linkage_;
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
