#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <numbers>

#include "interfaces/robot/mass.hpp"
#include "interfaces/xml/document.hpp"
#include "interfaces/xml/tree.hpp"
#include "sim/formats/collada.hpp"
#include "sim/formats/formats.hpp"

namespace formats {
namespace {

using xml::Tree;
using xml::Vec3;
using Vector = Eigen::Vector3d;

std::string text_of(const Vec3& v) { return xml::Codec<Vec3>::write(v); }
std::string text_of(double v) { return xml::write_number(v); }
double degrees(double rad) { return rad * 180 / std::numbers::pi; }
Vector vec(const Vec3& v) { return {v[0], v[1], v[2]}; }

Tree& add_turn(Tree& parent, const Eigen::AngleAxisd& turn) {
  const Vector& a = turn.axis();
  return parent.add("rotate",
                    text_of({a.x(), a.y(), a.z()}) + " " + text_of(degrees(turn.angle())));
}

void add_revolute(Tree& joint, int k, const Vec3& axis, double min_rad, double max_rad) {
  Tree& node = joint.add("revolute").set("sid", "axis" + std::to_string(k));
  node.add("axis", text_of(axis));
  Tree& limits = node.add("limits");
  limits.add("min", text_of(degrees(min_rad)));
  limits.add("max", text_of(degrees(max_rad)));
}

/// A COLLADA joint may have several axes: a ball joint has three <revolute>, a free joint also
/// three <prismatic>. A fixed joint has one <revolute> with the range 0 to 0.
void add_joint(Tree& library, const erp::Joint& joint) {
  Tree& node = library.add("joint").set("id", joint_id(joint.name)).set("name", joint.name);
  const Vec3 unit[]{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  switch (joint.type) {
    case erp::JointType::revolute:
      return add_revolute(node, 0, joint.axis, joint.min_rad, joint.max_rad);
    case erp::JointType::fixed:
      return add_revolute(node, 0, unit[0], 0, 0);
    case erp::JointType::free:
      for (int k = 0; k < 3; ++k)
        node.add("prismatic").set("sid", "slide" + std::to_string(k)).add("axis", text_of(unit[k]));
      [[fallthrough]];
    case erp::JointType::spherical:
      for (int k = 0; k < 3; ++k) add_revolute(node, k, unit[k], -joint.max_rad, joint.max_rad);
  }
}

/// Principal axes of the inertia, in the frame of the rigid body.
void add_inertia(Tree& body, const erp::Mass& mass) {
  const auto& i = mass.inertia_kg_m2;
  Eigen::Matrix3d tensor;
  tensor << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2];
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Vector principal = tensor.diagonal();
  if (!tensor.isDiagonal(0)) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(tensor);
    axes = solver.eigenvectors(), principal = solver.eigenvalues();
    if (axes.determinant() < 0) axes.col(0) *= -1;
  }
  body.add("mass", text_of(mass.mass_kg));
  Tree& frame = body.add("mass_frame");
  frame.add("translate", text_of(mass.com_m));
  if (!axes.isIdentity(0)) add_turn(frame, Eigen::AngleAxisd(axes));
  body.add("inertia", text_of({principal.x(), principal.y(), principal.z()}));
}

void add_shape(Tree& body, const erp::Sphere& sphere) {
  Tree& shape = body.add("shape");
  shape.add("sphere").add("radius", text_of(sphere.radius_m));
  shape.add("translate", text_of(sphere.at_m));
}
void add_shape(Tree& body, const erp::Box& box) {
  Tree& shape = body.add("shape");
  shape.add("box").add("half_extents",
                       text_of({box.size_m[0] / 2, box.size_m[1] / 2, box.size_m[2] / 2}));
  shape.add("translate", text_of(box.at_m));
}
/// The axis of a COLLADA capsule is y.
void add_shape(Tree& body, const erp::Capsule& capsule) {
  const Vector from = vec(capsule.from_m), line = vec(capsule.to_m) - from;
  const Vector middle = from + line / 2;
  Tree& shape = body.add("shape");
  Tree& node = shape.add("capsule");
  node.add("height", text_of(line.norm()));
  node.add("radius", text_of({capsule.radius_m, capsule.radius_m, capsule.radius_m}));
  shape.add("translate", text_of({middle.x(), middle.y(), middle.z()}));
  if (line.norm() > 0)
    add_turn(shape, Eigen::AngleAxisd(Eigen::Quaterniond::FromTwoVectors(Vector::UnitY(), line)));
}
void add_shape(Tree&, const erp::Weight&) {}

/// A body without solids has a sphere of radius 0, because the schema requires a shape.
void add_rigid_body(Tree& model, const erp::Body& body) {
  Tree& node = model.add("rigid_body").set("sid", body_id(body.name)).set("name", body.name);
  Tree& common = node.add("technique_common");
  const erp::Mass mass = mass_of(body);
  common.add("dynamic", mass.mass_kg > 0 ? "true" : "false");
  if (mass.mass_kg > 0) add_inertia(common, mass);
  for (const erp::Part& part : body.parts)
    std::visit([&](const auto& p) { add_shape(common, p); }, part);
  if (common.children.back().name != "shape")
    common.add("shape").add("sphere").add("radius", text_of(0));
}

/// Adds a prefix to the names, because COLLADA readers would interpret <joint> as their own
/// element.
Tree copy_of(const xml::Element& element) {
  Tree copy(erp_prefix + element.name);
  for (const auto& attribute : element.attributes) copy.set(attribute.name, attribute.value);
  for (const auto& child : element.children) copy.children.push_back(copy_of(child));
  return copy;
}

class Collada {
 public:
  explicit Collada(const erp::Robot& robot)
      : robot_(robot), bodies_(robot.bodies()), joints_(robot.joints()) {}

  std::string write() {
    root_.set("xmlns", collada_namespace).set("version", "1.5.0");
    add_asset();
    Tree& joints = root_.add("library_joints");
    for (const erp::Joint& joint : joints_) add_joint(joints, joint);
    add_kinematics();
    add_physics();
    add_visual();
    add_scenes();
    return xml::write_tree(root_);
  }

 private:
  /// The time stamp is constant. Equal robots therefore give equal files.
  void add_asset() {
    Tree& asset = root_.add("asset");
    asset.add("contributor").add("authoring_tool", "erp");
    asset.add("created", "1970-01-01T00:00:00Z");
    asset.add("modified", "1970-01-01T00:00:00Z");
    asset.add("unit").set("name", "meter").set("meter", 1.0);
    asset.add("up_axis", "Z_UP");
  }

  const erp::Joint* joint_of(const std::string& body) const {
    for (const erp::Joint& joint : joints_)
      if (joint.child == body) return &joint;
    return nullptr;
  }

  void add_kinematics() {
    Tree& model = root_.add("library_kinematics_models").add("kinematics_model");
    model.set("id", "kinematics").set("name", robot_.name);
    Tree& common = model.add("technique_common");
    for (const erp::Joint& joint : joints_)
      common.add("instance_joint").set("url", "#" + joint_id(joint.name)).set("sid", joint.name);
    for (const erp::Body& body : bodies_)
      if (!joint_of(body.name)) add_link(common, body);
    Tree& extra = model.add("extra").set("type", "robot");
    extra.add("technique")
        .set("profile", erp_profile)
        .children.push_back(copy_of(xml::parse_document(erp::write_robot(robot_), robot_.name)));
  }

  void add_link(Tree& parent, const erp::Body& body) {
    Tree& link = parent.add("link").set("sid", body.name).set("name", body.name);
    for (const erp::Joint& joint : joints_) {
      if (joint.parent != body.name) continue;
      Tree& attachment = link.add("attachment_full").set("joint", "kinematics/" + joint.name);
      attachment.add("translate", text_of(joint.at_m));
      for (const erp::Body& child : bodies_)
        if (child.name == joint.child) add_link(attachment, child);
    }
  }

  void add_physics() {
    Tree& model = root_.add("library_physics_models").add("physics_model").set("id", "physics");
    for (const erp::Body& body : bodies_) add_rigid_body(model, body);
  }

  void add_visual() {
    Tree& scene = root_.add("library_visual_scenes").add("visual_scene").set("id", "visual");
    for (const erp::Body& body : bodies_)
      if (!joint_of(body.name)) add_node(scene, body, nullptr);
  }

  /// Starting poses of the bodies.
  void add_node(Tree& parent, const erp::Body& body, const erp::Joint* joint) {
    Tree& node = parent.add("node").set("id", body_id(body.name)).set("name", body.name);
    if (joint) node.add("translate", text_of(joint->at_m));
    if (joint && joint->type == erp::JointType::revolute && joint->initial_rad != 0)
      node.add("rotate", text_of(joint->axis) + " " + text_of(degrees(joint->initial_rad)));
    for (const erp::Joint& next : joints_)
      for (const erp::Body& child : bodies_)
        if (next.parent == body.name && child.name == next.child) add_node(node, child, &next);
  }

  void add_scenes() {
    Tree& physics = root_.add("library_physics_scenes").add("physics_scene");
    physics.set("id", "physics_scene");
    Tree& bodies = physics.add("instance_physics_model").set("url", "#physics");
    for (const erp::Body& body : bodies_)
      bodies.add("instance_rigid_body")
          .set("body", body_id(body.name))
          .set("target", "#" + body_id(body.name));
    physics.add("technique_common").add("gravity", text_of(robot_.gravity_m_per_s2()));
    Tree& kinematics = root_.add("library_kinematics_scenes").add("kinematics_scene");
    kinematics.set("id", "kinematics_scene");
    kinematics.add("instance_kinematics_model").set("url", "#kinematics");
    Tree& scene = root_.add("scene");
    scene.add("instance_visual_scene").set("url", "#visual");
    scene.add("instance_physics_scene").set("url", "#physics_scene");
    scene.add("instance_kinematics_scene").set("url", "#kinematics_scene");
  }

  const erp::Robot& robot_;
  std::vector<erp::Body> bodies_;
  std::vector<erp::Joint> joints_;
  Tree root_{"COLLADA"};
};

}  // namespace

std::string to_collada(const erp::Robot& robot) { return Collada(robot).write(); }

}  // namespace formats
