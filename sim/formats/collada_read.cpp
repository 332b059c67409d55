#include <algorithm>
#include <map>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "interfaces/xml/reader.hpp"
#include "sim/formats/collada.hpp"
#include "sim/formats/formats.hpp"

namespace formats {
namespace {

using Eigen::Isometry3d;

constexpr double unlimited = 3.14159;  // rad: half a turn, rounded down

double radians(double degrees) { return degrees * std::numbers::pi / 180; }
Vec3 vec(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

/// The last part of a URL or sid path: "#kinematics/elbow" → "elbow".
std::string last_part(const std::string& path) {
  const auto cut = path.find_last_of("#/");
  return cut == std::string::npos ? path : path.substr(cut + 1);
}

std::string required_attribute(const Foreign& element, const char* attribute) {
  if (const auto value = element.attribute(attribute)) return *value;
  element.reject(std::string("has no ") + attribute, std::string("add ") + attribute + "=\"…\"");
}

/// The product of <translate> and <rotate> in an element; lengths in the unit of the file.
Isometry3d placement(const Foreign& element) {
  Isometry3d pose = Isometry3d::Identity();
  for (const Foreign& step : element.children()) {
    if (step.tag() == "translate") pose = pose * Eigen::Translation3d(vec(step.numbers(3)));
    if (step.tag() == "rotate") {
      const auto v = step.numbers(4);
      if (const Vec3 axis = vec(v); axis.norm() > 0)
        pose = pose * Eigen::AngleAxisd(radians(v[3]), axis.normalized());
    }
    if (step.tag() == "matrix")
      step.reject("is not supported", "give the pose as <translate> and <rotate>");
  }
  return pose;
}

/// Type, axis and range of a <joint>.
struct JointKind {
  erp::JointType type;
  Vec3 axis = Vec3::UnitX();
  double min_rad = -unlimited, max_rad = unlimited;
};

JointKind kind_of(const Foreign& joint) {
  const auto turns = joint.all("revolute"), slides = joint.all("prismatic");
  if (turns.size() == 3 && (slides.size() == 3 || slides.empty())) {
    JointKind kind{slides.empty() ? erp::JointType::spherical : erp::JointType::free};
    if (const auto limits = turns[0].one("limits"))
      kind.max_rad = radians(limits->need("max").number());
    return kind;
  }
  if (turns.size() != 1 || !slides.empty())
    joint.reject("has " + std::to_string(turns.size()) + " <revolute> and " +
                     std::to_string(slides.size()) + " <prismatic>",
                 "use one <revolute>, three, or three of each");
  JointKind kind{erp::JointType::revolute, vec(turns[0].need("axis").numbers(3))};
  if (const auto limits = turns[0].one("limits")) {
    kind.min_rad = radians(limits->need("min").number());
    kind.max_rad = radians(limits->need("max").number());
  }
  if (kind.min_rad == 0 && kind.max_rad == 0) kind.type = erp::JointType::fixed;
  return kind;
}

/// The element with its tags renamed to those of robot.xml.
xml::Element renamed(xml::Element element) {
  if (element.name.starts_with(erp_prefix)) element.name.erase(0, erp_prefix.size());
  for (xml::Element& child : element.children) child = renamed(std::move(child));
  return element;
}

class Document {
 public:
  explicit Document(const Foreign& root) : root_(root) {
    const auto asset = root.one("asset");
    if (const auto unit = asset ? asset->one("unit") : std::nullopt;
        unit && unit->attribute("meter"))
      meter_ = unit->number("meter");
    const auto up = asset ? asset->one("up_axis") : std::nullopt;
    const std::string axis = up ? up->text() : "Y_UP";
    if (axis == "Y_UP") to_z_up_ = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX());
    if (axis == "X_UP") to_z_up_ = Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitY());
    for (const Foreign& library : root.all("library_joints"))
      for (const Foreign& joint : library.all("joint"))
        library_.emplace(required_attribute(joint, "id"), joint);
    for (const Foreign& library : root.all("library_physics_models"))
      for (const Foreign& model : library.all("physics_model"))
        for (const Foreign& body : model.all("rigid_body"))
          rigid_.emplace(body.attribute("name").value_or(required_attribute(body, "sid")), body);
  }

  Foreign model() const {
    for (const Foreign& library : root_.all("library_kinematics_models"))
      if (const auto model = library.one("kinematics_model")) return *model;
    root_.reject("has no <kinematics_model>", "export one with kinematics (COLLADA 1.5)");
  }

  Linkage linkage() {
    const Foreign kinematics = model();
    linkage_.name = kinematics.attribute("name").value_or("robot");
    const Foreign common = kinematics.need("technique_common");
    for (const Foreign& joint : common.all("joint"))
      joints_.emplace(required_attribute(joint, "sid"), joint);
    for (const Foreign& instance : common.all("instance_joint")) resolve(instance);
    for (const Foreign& link : common.all("link")) add(link, Isometry3d(to_z_up_));
    return std::move(linkage_);
  }

  /// Gravity of the first physics scene that defines it.
  std::optional<xml::Vec3> gravity_m_per_s2() const {
    for (const Foreign& library : root_.all("library_physics_scenes"))
      for (const Foreign& scene : library.all("physics_scene"))
        if (const auto common = scene.one("technique_common"); common && common->one("gravity")) {
          const Vec3 g = meter_ * (to_z_up_ * vec(common->need("gravity").numbers(3)));
          return xml::Vec3{g.x(), g.y(), g.z()};
        }
    return {};
  }

  /// The robot.xml in the <extra> element, if there is one.
  std::optional<erp::Robot> exact() const {
    for (const Foreign& extra : model().all("extra"))
      for (const Foreign& technique : extra.all("technique"))
        if (technique.attribute("profile") == erp_profile) {
          erp::Robot robot;
          std::vector<xml::Error> errors;
          xml::Reader::fill(robot, renamed(technique.need(erp_prefix + "robot").element()), errors);
          xml::throw_if_any(std::move(errors));
          return robot;
        }
    return {};
  }

 private:
  void resolve(const Foreign& instance) {
    const std::string url = required_attribute(instance, "url");
    const auto match = library_.find(last_part(url));
    if (match == library_.end())
      instance.reject("url=\"" + url + "\" names no joint", "define the joint in <library_joints>");
    joints_.emplace(required_attribute(instance, "sid"), match->second);
  }

  /// Adds a link with its frame's pose in metres, and all its descendants.
  void add(const Foreign& link, const Isometry3d& parent) {
    const Isometry3d frame = parent * scaled(placement(link));
    const std::string name = link.attribute("name").value_or(required_attribute(link, "sid"));
    linkage_.links.push_back(link_of(name, frame));
    for (const Foreign& attachment : link.all("attachment_full")) {
      const Isometry3d at = frame * scaled(placement(attachment));
      const Foreign child = attachment.need("link");
      add_joint(attachment, name,
                child.attribute("name").value_or(required_attribute(child, "sid")), at);
      add(child, at);
    }
  }

  void add_joint(const Foreign& attachment, const std::string& parent, const std::string& child,
                 const Isometry3d& at) {
    const std::string sid = last_part(required_attribute(attachment, "joint"));
    const auto match = joints_.find(sid);
    if (match == joints_.end())
      attachment.reject("joint=\"" + sid + "\" names no joint of this model",
                        "add an <instance_joint sid=\"" + sid + "\">");
    const JointKind kind = kind_of(match->second);
    linkage_.joints.push_back({.name = match->second.attribute("name").value_or(sid),
                               .parent = parent,
                               .child = child,
                               .type = kind.type,
                               .at_m = at.translation(),
                               .axis = at.linear() * kind.axis,
                               .min_rad = kind.min_rad,
                               .max_rad = kind.max_rad});
  }

  Link link_of(const std::string& name, const Isometry3d& frame) const {
    Link link{.name = name};
    const auto match = rigid_.find(name);
    if (match == rigid_.end()) return link;
    const Foreign body = match->second.need("technique_common");
    const auto dynamic = body.one("dynamic");
    if (!body.one("mass") || (dynamic && dynamic->text() == "false")) return link;
    const auto mass_frame = body.one("mass_frame");
    const Isometry3d at =
        frame * (mass_frame ? scaled(placement(*mass_frame)) : Isometry3d::Identity());
    const Vec3 principal = meter_ * meter_ * vec(body.need("inertia").numbers(3));
    link.mass_kg = body.need("mass").number();
    link.com_m = at.translation();
    link.inertia_kg_m2 = at.linear() * principal.asDiagonal() * at.linear().transpose();
    return link;
  }

  Isometry3d scaled(Isometry3d pose) const {
    pose.translation() *= meter_;
    return pose;
  }

  Foreign root_;
  double meter_ = 1;
  Eigen::AngleAxisd to_z_up_{0, Vec3::UnitX()};
  std::map<std::string, Foreign> library_, joints_, rigid_;
  Linkage linkage_;
};

}  // namespace

erp::Robot from_collada(const std::string& file) {
  const xml::Element element = xml::read_document(file);
  const Foreign root(element);
  if (root.tag() != "COLLADA")
    root.reject("is not a COLLADA file", "the root element must be <COLLADA>");
  if (const std::string version = root.attribute("version").value_or("");
      !version.starts_with("1.5"))
    root.reject("version=\"" + version + "\" has no kinematics", "export COLLADA 1.5");
  Document document(root);
  erp::Robot standard = robot_of(document.linkage());
  if (const auto gravity = document.gravity_m_per_s2())
    standard.skeletons.front().gravity_m_per_s2 = gravity;
  auto exact = document.exact();
  return exact ? with_skeleton(std::move(*exact), standard) : standard;
}

}  // namespace formats
