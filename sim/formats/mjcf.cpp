#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <stdexcept>

#include "interfaces/robot/mass.hpp"
#include "interfaces/xml/tree.hpp"
#include "sim/formats/formats.hpp"
#include "sim/model/actuator/routing.hpp"
#include "sim/model/skeleton/skeleton_model.hpp"

namespace formats {
namespace {

using xml::Tree;
using xml::Vec3;

constexpr double side_reach = 1.5;  // chosen: position of the side site, in radii of the pulley

Vec3 moved_along(const Vec3& from, const Vec3& direction, double distance) {
  const double length = std::hypot(direction[0], direction[1], direction[2]);
  Vec3 to = from;
  for (std::size_t i = 0; i < 3; ++i) to[i] += distance * direction[i] / length;
  return to;
}

/// In MJCF's order: xx yy zz xy xz yz.
std::vector<double> inertia_of(const erp::Mass& mass) {
  return {mass.inertia_kg_m2.begin(), mass.inertia_kg_m2.end()};
}

bool is_zero(const Vec3& v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

/// Writes one robot; the tree of bodies starts at its roots.
class Mjcf {
 public:
  explicit Mjcf(const erp::Robot& robot)
      : robot_(robot), bodies_(robot.bodies()), joints_(robot.joints()) {
    const sim::RobotTree tree(robot);
    const sim::SkeletonModel model(tree, Eigen::Vector3d::Zero());
    names_ = tree.names;
    start_poses_ = {model.poses().begin(), model.poses().end()};
  }

  std::string write() {
    root_.set("model", robot_.name);
    root_.add("compiler").set("angle", "radian").set("inertiafromgeom", "false");
    root_.add("option").set("timestep", 0.001).set("gravity", robot_.gravity_m_per_s2());
    root_.add("size").set("njmax", 1000).set("nconmax", 200);
    Tree& world = root_.add("worldbody");
    for (const erp::Body& body : bodies_)
      if (!joint_of(body)) add_body(world, body, nullptr);
    Tree& tendons = root_.add("tendon");
    Tree& motors = root_.add("actuator");
    for (const erp::Actuator& actuator : robot_.actuators) {
      route(tendons, actuator);
      motors.add("motor")
          .set("name", actuator.name)
          .set("tendon", actuator.name)
          .set("gear", -1)
          .set("ctrllimited", true)
          .set("ctrlrange", std::vector<double>{0, actuator.max_tension_N});
    }
    root_.add("keyframe").add("key").set("name", "start").set("qpos", start_positions_);
    return xml::write_tree(root_);
  }

 private:
  const erp::Joint* joint_of(const erp::Body& body) const {
    for (const erp::Joint& joint : joints_)
      if (joint.child == body.name) return &joint;
    return nullptr;
  }

  void add_body(Tree& parent, const erp::Body& body, const erp::Joint* joint) {
    Tree& node = parent.add("body").set("name", body.name);
    if (joint) node.set("pos", joint->at_m);
    if (joint) add_joint(node, *joint);
    if (const erp::Mass mass = mass_of(body); mass.mass_kg > 0)
      node.add("inertial")
          .set("pos", mass.com_m)
          .set("mass", mass.mass_kg)
          .set("fullinertia", inertia_of(mass));
    tree_of_[body.name] = &node;
    for (const erp::Body& child : bodies_)
      if (const erp::Joint* child_joint = joint_of(child);
          child_joint && child_joint->parent == body.name)
        add_body(child_joint->type == erp::JointType::free ? parent : node, child, child_joint);
  }

  void add_joint(Tree& body, const erp::Joint& joint) {
    if (joint.type == erp::JointType::fixed) return;
    if (joint.type == erp::JointType::free) return add_freedom(body, joint);
    const bool is_ball = joint.type == erp::JointType::spherical;
    Tree& node = body.add("joint").set("name", joint.name).set("type", is_ball ? "ball" : "hinge");
    if (is_ball) start_positions_.insert(start_positions_.end(), {1, 0, 0, 0});
    else node.set("axis", joint.axis), start_positions_.push_back(joint.initial_rad);
    node.set("limited", true)
        .set("range", std::vector<double>{is_ball ? 0 : joint.min_rad, joint.max_rad})
        .set("damping", joint.viscous_Nm_s_per_rad)
        .set("frictionloss", joint.coulomb_Nm);
  }

  void add_freedom(Tree& body, const erp::Joint& joint) {
    body.add("freejoint").set("name", joint.name);
    start_positions_.insert(start_positions_.end(), joint.at_m.begin(), joint.at_m.end());
    start_positions_.insert(start_positions_.end(), {1, 0, 0, 0});
  }

  void route(Tree& tendons, const erp::Actuator& actuator) {
    Tree& spatial = tendons.add("spatial").set("name", actuator.name);
    bool after_pulley = false;
    int count = 0;
    for (const auto& element : actuator.tendon.path) {
      const std::string name = actuator.name + "_" + std::to_string(++count);
      const auto* pulley = std::get_if<erp::Pulley>(&element);
      if (pulley && after_pulley)
        throw std::invalid_argument("actuator \"" + actuator.name + "\": element " +
                                    std::to_string(count) +
                                    " of its path is a pulley directly after a pulley, which MJCF "
                                    "does not support; add an <attach> between them");
      after_pulley = pulley != nullptr;
      if (pulley) wrap(spatial, *pulley, name, wrap_middle(actuator, count - 1));
      else add_site(spatial, std::get<erp::Attach>(element), name);
    }
  }

  void add_site(Tree& spatial, const erp::Attach& attach, const std::string& name) {
    tree_of_.at(attach.body)->add("site").set("name", name).set("pos", attach.at_m);
    spatial.add("site").set("site", name);
  }

  /// Direction of the middle of the wrap around a pulley with an axis, in the starting pose and the
  /// pulley's body frame. MJCF has no direction of wrapping, only a side.
  Vec3 wrap_middle(const erp::Actuator& actuator, int element) const {
    const sim::Routing routing(actuator.tendon, names_);
    const auto k = static_cast<std::size_t>(element);
    const sim::PathElement& pulley = routing.elements()[k];
    if (pulley.axis.isZero(0)) return {pulley.side.x(), pulley.side.y(), pulley.side.z()};
    const sim::PathShape shape = routing.solve(start_poses_);
    const auto& body_rotation = start_poses_[static_cast<std::size_t>(pulley.body)].rotation;
    sim::Vec3 from = body_rotation.transpose() * (shape.exit_m[k - 1] - shape.pulls[k].at_m);
    from -= pulley.axis.dot(from) * pulley.axis;
    const sim::Vec3 middle = Eigen::AngleAxisd(shape.around_rad[k] / 2, pulley.axis) * from;
    return {middle.x(), middle.y(), middle.z()};
  }

  void wrap(Tree& spatial, const erp::Pulley& pulley, const std::string& name, const Vec3& side) {
    if (pulley.turns > 0)
      throw std::invalid_argument("pulley " + name + ": MJCF does not support turns=; remove it");
    Tree& body = *tree_of_.at(pulley.body);
    Tree& solid = body.add("geom").set("name", name);
    if (pulley.shape == erp::PulleyShape::cylinder)
      solid.set("type", "cylinder")
          .set("size", std::vector<double>{pulley.radius_m, pulley.radius_m})
          .set("zaxis", *pulley.axis);
    else solid.set("type", "sphere").set("size", pulley.radius_m);
    solid.set("pos", pulley.center_m).set("mass", 0).set("contype", 0).set("conaffinity", 0);
    Tree& geom = spatial.add("geom").set("geom", name);
    if (is_zero(side)) return;
    body.add("site")
        .set("name", name + "_side")
        .set("pos", moved_along(pulley.center_m, side, side_reach * pulley.radius_m));
    geom.set("sidesite", name + "_side");
  }

  const erp::Robot& robot_;
  std::vector<erp::Body> bodies_;
  std::vector<erp::Joint> joints_;
  Tree root_{"mujoco"};
  std::map<std::string, Tree*> tree_of_;
  std::vector<double> start_positions_;
  std::vector<std::string> names_;          ///< names of the bodies
  std::vector<sim::BodyPose> start_poses_;  ///< starting poses of the bodies
};

}  // namespace

std::string to_mjcf(const erp::Robot& robot) { return Mjcf(robot).write(); }

}  // namespace formats
