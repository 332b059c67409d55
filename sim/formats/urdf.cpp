#include <algorithm>
#include <map>

#include "interfaces/robot/mass.hpp"
#include "interfaces/xml/tree.hpp"
#include "sim/formats/formats.hpp"
#include "sim/formats/linkage.hpp"

namespace formats {
namespace {

using xml::Tree;

constexpr double unlimited_rad = 3.14159;  // half a turn, rounded down
constexpr auto urdf_world = "world";

void add_link(Tree& root, const std::string& name, const erp::Mass& mass) {
  Tree& link = root.add("link").set("name", name);
  if (mass.mass_kg == 0) return;
  Tree& inertial = link.add("inertial");
  inertial.add("origin").set("xyz", mass.com_m).set("rpy", xml::Vec3{0, 0, 0});
  inertial.add("mass").set("value", mass.mass_kg);
  constexpr const char* names[]{"ixx", "iyy", "izz", "ixy", "ixz", "iyz"};
  Tree& inertia = inertial.add("inertia");
  for (std::size_t k = 0; k < 6; ++k) inertia.set(names[k], mass.inertia_kg_m2[k]);
}

Tree& add_joint(Tree& root, const std::string& name, const char* type, const std::string& parent,
                const std::string& child, const xml::Vec3& at_m) {
  Tree& joint = root.add("joint").set("name", name).set("type", type);
  joint.add("parent").set("link", parent);
  joint.add("child").set("link", child);
  joint.add("origin").set("xyz", at_m).set("rpy", xml::Vec3{0, 0, 0});
  return joint;
}

void add_hinge(Tree& root, const std::string& name, const std::string& parent,
               const std::string& child, const xml::Vec3& at_m, const xml::Vec3& axis,
               const erp::Joint& source) {
  Tree& joint = add_joint(root, name, "revolute", parent, child, at_m);
  joint.add("axis").set("xyz", axis);
  const bool is_ball = source.type == erp::JointType::spherical;
  joint.add("limit")
      .set("lower", is_ball ? -source.max_rad : source.min_rad)
      .set("upper", source.max_rad)
      .set("effort", 0)
      .set("velocity", 0);
  joint.add("dynamics")
      .set("damping", source.viscous_Nm_s_per_rad)
      .set("friction", source.coulomb_Nm);
}

/// A ball joint is written as three hinges about x, y, z over two links without mass.
void add_ball(Tree& root, const erp::Joint& joint) {
  const std::string x = joint.child + "_x", y = joint.child + "_y";
  add_link(root, x, {}), add_link(root, y, {});
  add_hinge(root, joint.name + "_x", joint.parent, x, joint.at_m, {1, 0, 0}, joint);
  add_hinge(root, joint.name + "_y", x, y, {0, 0, 0}, {0, 1, 0}, joint);
  add_hinge(root, joint.name + "_z", y, joint.child, {0, 0, 0}, {0, 0, 1}, joint);
}

void add_joint(Tree& root, const erp::Joint& joint) {
  switch (joint.type) {
    case erp::JointType::spherical:
      return add_ball(root, joint);
    case erp::JointType::revolute:
      return add_hinge(root, joint.name, joint.parent, joint.child, joint.at_m, joint.axis, joint);
    case erp::JointType::fixed:
      add_joint(root, joint.name, "fixed", joint.parent, joint.child, joint.at_m);
      return;
    case erp::JointType::free:
      add_joint(root, joint.name, "floating", joint.parent, joint.child, joint.at_m);
  }
}

/// URDF allows one root: several roots are connected to an additional link.
void join_roots(Tree& root, const erp::Robot& robot) {
  std::vector<std::string> roots;
  const auto joints = robot.joints();
  for (const erp::Body& body : robot.bodies())
    if (std::ranges::find(joints, body.name, &erp::Joint::child) == joints.end())
      roots.push_back(body.name);
  if (roots.size() < 2) return;
  add_link(root, urdf_world, {});
  for (const std::string& name : roots)
    add_joint(root, std::string(urdf_world) + "_to_" + name, "fixed", urdf_world, name, {0, 0, 0});
}

// Reading.

Eigen::Isometry3d origin_of(const Foreign& element) {
  const auto origin = element.one("origin");
  if (!origin) return Eigen::Isometry3d::Identity();
  std::vector<double> v(3), rpy(3);
  if (origin->attribute("xyz")) v = origin->numbers("xyz", 3);
  if (origin->attribute("rpy")) rpy = origin->numbers("rpy", 3);
  v.insert(v.end(), rpy.begin(), rpy.end());
  return pose_of(v);
}

erp::JointType type_of_joint(const Foreign& joint) {
  const std::string type = joint.attribute("type").value_or("");
  if (type == "revolute" || type == "continuous") return erp::JointType::revolute;
  if (type == "fixed") return erp::JointType::fixed;
  if (type == "floating") return erp::JointType::free;
  joint.reject("type=\"" + type + "\" is not supported",
               "use revolute, continuous, fixed or floating");
}

/// Computes the poses of links from the roots outwards.
class Urdf {
 public:
  explicit Urdf(const Foreign& root) : root_(root) {
    for (const Foreign& joint : root.all("joint")) joints_.emplace(link_of(joint, "child"), joint);
  }

  Linkage linkage() {
    Linkage linkage{root_.name(), {}, {}};
    for (const Foreign& link : root_.all("link")) linkage.links.push_back(link_from(link));
    for (const Foreign& joint : root_.all("joint")) linkage.joints.push_back(joint_from(joint));
    return linkage;
  }

 private:
  static std::string link_of(const Foreign& joint, const char* end) {
    const Foreign element = joint.need(end);
    if (const auto link = element.attribute("link")) return *link;
    element.reject("has no link", "add link=\"…\"");
  }

  Eigen::Isometry3d pose(const std::string& link, std::size_t depth = 0) const {
    const auto joint = joints_.find(link);
    if (joint == joints_.end()) return Eigen::Isometry3d::Identity();
    if (depth > joints_.size())
      joint->second.reject("is part of a loop",
                           "a skeleton must be a tree; remove one joint of the loop");
    return pose(link_of(joint->second, "parent"), depth + 1) * origin_of(joint->second);
  }

  Link link_from(const Foreign& element) const {
    Link link{.name = element.name()};
    const auto inertial = element.one("inertial");
    if (!inertial) return link;
    const Eigen::Isometry3d at = pose(link.name) * origin_of(*inertial);
    const Foreign i = inertial->need("inertia");
    Eigen::Matrix3d inertia;
    inertia << i.number("ixx"), i.number("ixy"), i.number("ixz"), i.number("ixy"), i.number("iyy"),
        i.number("iyz"), i.number("ixz"), i.number("iyz"), i.number("izz");
    link.mass_kg = inertial->need("mass").number("value");
    link.com_m = at.translation();
    link.inertia_kg_m2 = at.linear() * inertia * at.linear().transpose();
    return link;
  }

  Connection joint_from(const Foreign& element) const {
    Connection joint{.name = element.name(),
                     .parent = link_of(element, "parent"),
                     .child = link_of(element, "child"),
                     .type = type_of_joint(element)};
    const Eigen::Isometry3d at = pose(joint.child);
    joint.at_m = at.translation();
    if (const auto axis = element.one("axis")) {
      const auto v = axis->numbers("xyz", 3);
      joint.axis = Vec3(v[0], v[1], v[2]);
    }
    joint.axis = at.linear() * joint.axis;
    const auto limit = element.one("limit");
    if (limit && element.attribute("type") == "revolute")
      joint.min_rad = limit->number("lower"), joint.max_rad = limit->number("upper");
    else joint.min_rad = -unlimited_rad, joint.max_rad = unlimited_rad;
    if (const auto dynamics = element.one("dynamics")) {
      if (dynamics->attribute("damping")) joint.viscous_Nm_s_per_rad = dynamics->number("damping");
      if (dynamics->attribute("friction")) joint.coulomb_Nm = dynamics->number("friction");
    }
    return joint;
  }

  Foreign root_;
  std::map<std::string, Foreign> joints_;  ///< by the name of the child link
};

}  // namespace

std::string to_urdf(const erp::Robot& robot) {
  Tree root("robot");
  root.set("name", robot.name);
  for (const erp::Body& body : robot.bodies()) add_link(root, body.name, mass_of(body));
  join_roots(root, robot);
  for (const erp::Joint& joint : robot.joints()) add_joint(root, joint);
  return xml::write_tree(root);
}

erp::Robot from_urdf(const std::string& file) {
  const xml::Element document = xml::read_document(file);
  const Foreign root(document);
  if (root.tag() != "robot") root.reject("is not a URDF file", "the root element must be <robot>");
  return robot_of(Urdf(root).linkage());
}

}  // namespace formats
