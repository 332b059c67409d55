#include <algorithm>
#include <map>

#include "interfaces/robot/mass.hpp"
#include "interfaces/xml/tree.hpp"
#include "sim/formats/formats.hpp"
#include "sim/formats/linkage.hpp"

namespace formats {
namespace {

using xml::Tree;

constexpr double half_turn_rad = 3.14159;  // rounded down
constexpr auto sdf_world = "world";
constexpr const char* moments[]{"ixx", "iyy", "izz", "ixy", "ixz", "iyz"};

std::string words(const std::vector<double>& values) {
  return xml::Codec<std::vector<double>>::write(values);
}
std::string pose_words(const xml::Vec3& at_m) {
  return words({at_m[0], at_m[1], at_m[2], 0, 0, 0});
}

void add_link(Tree& model, const erp::Body& body, const Vec3& origin_m) {
  Tree& link = model.add("link").set("name", body.name);
  link.add("pose", pose_words(xml::Vec3{origin_m.x(), origin_m.y(), origin_m.z()}));
  const erp::Mass mass = mass_of(body);
  if (mass.mass_kg == 0) return;
  Tree& inertial = link.add("inertial");
  inertial.add("pose", pose_words(mass.com_m));
  inertial.add("mass", xml::write_number(mass.mass_kg));
  Tree& inertia = inertial.add("inertia");
  for (std::size_t k = 0; k < 6; ++k)
    inertia.add(moments[k], xml::write_number(mass.inertia_kg_m2[k]));
}

Tree& add_joint(Tree& model, const std::string& name, const char* type, const std::string& parent,
                const std::string& child) {
  Tree& joint = model.add("joint").set("name", name).set("type", type);
  joint.add("parent", parent);
  joint.add("child", child);
  return joint;
}

void add_joint(Tree& model, const erp::Joint& joint) {
  if (joint.type == erp::JointType::free) return;  // a link without a joint is free
  const bool hinge = joint.type == erp::JointType::revolute;
  const char* type = hinge                                     ? "revolute"
                     : joint.type == erp::JointType::spherical ? "ball"
                                                               : "fixed";
  Tree& element = add_joint(model, joint.name, type, joint.parent, joint.child);
  if (!hinge) return;
  Tree& axis = element.add("axis");
  axis.add("xyz", words({joint.axis[0], joint.axis[1], joint.axis[2]}));
  Tree& limit = axis.add("limit");
  limit.add("lower", xml::write_number(joint.min_rad));
  limit.add("upper", xml::write_number(joint.max_rad));
  Tree& dynamics = axis.add("dynamics");
  dynamics.add("damping", xml::write_number(joint.viscous_Nm_s_per_rad));
  dynamics.add("friction", xml::write_number(joint.coulomb_Nm));
}

// Reading.

Eigen::Isometry3d pose_in(const Foreign& element) {
  const auto pose = element.one("pose");
  if (!pose) return Eigen::Isometry3d::Identity();
  if (const auto other = pose->attribute("relative_to"); other && !other->empty())
    pose->reject("relative_to=\"" + *other + "\" is not supported",
                 "leave relative_to out and give the pose in the default frame of SDF");
  return pose_of(pose->numbers(6));
}

erp::JointType type_of(const Foreign& joint) {
  const std::string type = joint.attribute("type").value_or("");
  if (type == "revolute" || type == "continuous") return erp::JointType::revolute;
  if (type == "ball") return erp::JointType::spherical;
  if (type == "fixed") return erp::JointType::fixed;
  joint.reject("type=\"" + type + "\" is not supported", "use revolute, continuous, ball or fixed");
}

class Sdf {
 public:
  explicit Sdf(const Foreign& model) : model_(model) {
    for (const Foreign& link : model.all("link")) poses_[link.name()] = pose_in(link);
  }

  Linkage linkage() {
    linkage_.name = model_.name();
    for (const Foreign& link : model_.all("link")) linkage_.links.push_back(link_of(link));
    for (const Foreign& joint : model_.all("joint")) add(joint);
    std::vector<Link> floating;
    for (const Link& link : linkage_.links)
      if (link.name != sdf_world && !fixed_to_world_.contains(link.name) && !has_joint(link.name))
        floating.push_back(link);
    for (const Link& link : floating) {
      ensure_world_link();
      linkage_.joints.push_back({.name = link.name + "_floats",
                                 .parent = sdf_world,
                                 .child = link.name,
                                 .type = erp::JointType::free,
                                 .at_m = poses_.at(link.name).translation()});
    }
    return linkage_;
  }

 private:
  bool has_joint(const std::string& link) const {
    return std::ranges::find(linkage_.joints, link, &Connection::child) != linkage_.joints.end();
  }
  void ensure_world_link() {
    if (std::ranges::find(linkage_.links, sdf_world, &Link::name) == linkage_.links.end())
      linkage_.links.push_back({.name = sdf_world});
  }

  Link link_of(const Foreign& element) const {
    Link link{.name = element.name()};
    const auto inertial = element.one("inertial");
    if (!inertial) return link;
    const Eigen::Isometry3d at = poses_.at(link.name) * pose_in(*inertial);
    const Foreign i = inertial->need("inertia");
    const auto entry = [&](const char* name) { return i.number_in(name, 0); };
    Eigen::Matrix3d inertia;
    inertia << entry("ixx"), entry("ixy"), entry("ixz"), entry("ixy"), entry("iyy"), entry("iyz"),
        entry("ixz"), entry("iyz"), entry("izz");
    link.mass_kg = inertial->need("mass").number();
    link.com_m = at.translation();
    link.inertia_kg_m2 = at.linear() * inertia * at.linear().transpose();
    return link;
  }

  void add(const Foreign& element) {
    Connection joint{.name = element.name(),
                     .parent = element.need("parent").text(),
                     .child = element.need("child").text(),
                     .type = type_of(element)};
    const auto child = poses_.find(joint.child);
    if (child == poses_.end())
      element.reject("its child \"" + joint.child + "\" is not a link",
                     "give the name of a link of the model");
    const Eigen::Isometry3d at = child->second * pose_in(element);
    joint.at_m = at.translation();
    if (joint.parent == sdf_world && joint.type == erp::JointType::fixed) {
      fixed_to_world_[joint.child] = true;
      return;
    }
    if (joint.parent == sdf_world) ensure_world_link();
    if (joint.type == erp::JointType::revolute) set_axis(joint, element.need("axis"), at);
    linkage_.joints.push_back(joint);
  }

  static void set_axis(Connection& joint, const Foreign& axis, const Eigen::Isometry3d& at) {
    const auto v = axis.need("xyz").numbers(3);
    joint.axis = at.linear() * Vec3(v[0], v[1], v[2]);
    if (const auto limit = axis.one("limit")) {
      joint.min_rad = std::max(-half_turn_rad, limit->number_in("lower", -half_turn_rad));
      joint.max_rad = std::min(half_turn_rad, limit->number_in("upper", half_turn_rad));
    }
    if (const auto dynamics = axis.one("dynamics")) {
      joint.viscous_Nm_s_per_rad = dynamics->number_in("damping", 0);
      joint.coulomb_Nm = dynamics->number_in("friction", 0);
    }
  }

  Foreign model_;
  std::map<std::string, Eigen::Isometry3d> poses_;
  std::map<std::string, bool> fixed_to_world_;
  Linkage linkage_;
};

}  // namespace

std::string to_sdf(const erp::Robot& robot) {
  Tree root("sdf");
  root.set("version", "1.7");
  Tree& model = root.add("model").set("name", robot.name);
  const auto bodies = robot.bodies();
  const auto joints = robot.joints();
  const auto origins = origins_of(robot);
  for (std::size_t k = 0; k < bodies.size(); ++k) add_link(model, bodies[k], origins[k]);
  for (const erp::Body& body : bodies)
    if (std::ranges::find(joints, body.name, &erp::Joint::child) == joints.end())
      add_joint(model, std::string(sdf_world) + "_to_" + body.name, "fixed", sdf_world, body.name);
  for (const erp::Joint& joint : joints) add_joint(model, joint);
  return xml::write_tree(root);
}

erp::Robot from_sdf(const std::string& file) {
  const xml::Element document = xml::read_document(file);
  const Foreign root(document);
  if (root.tag() != "sdf") root.reject("is not an SDF file", "the root element must be <sdf>");
  return robot_of(Sdf(root.need("model")).linkage());
}

}  // namespace formats
