#include "sim/formats/scene.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "sim/model/actuator/path_line.hpp"
#include "sim/model/actuator/routing.hpp"
#include "sim/model/skeleton/skeleton_model.hpp"

namespace formats {
namespace {

using sim::vec, sim::Vec3;

constexpr double bone_m = 0.008;           // drawn width of bodies without a shape
constexpr double arc_step_rad = 0.1;       // resolution of lines around pulleys
constexpr double weight_kg_per_m3 = 4000;  // approximate density of a motor
constexpr auto weight_fill = "#b9b3a5";
constexpr auto bone_fill = "#e6e2d8", bone_edge = "#8a8375", joint_fill = "#3b6ea5";
constexpr auto pulley_edge = "#9db4c8", muscle = "#c0392b";

class Scene {
 public:
  explicit Scene(const erp::Robot& robot)
      : tree_(robot), model_(tree_, Vec3::Zero()), robot_(robot) {
    for (std::size_t k = 0; k < tree_.bodies.size(); ++k) add_body(static_cast<int>(k));
    for (const erp::Actuator& actuator : robot_.actuators) add_tendon(actuator);
  }
  std::vector<Stroke> strokes;

 private:
  Vec3 point(int body, const Vec3& at) const {
    const sim::BodyPose& pose = model_.poses()[static_cast<std::size_t>(body)];
    return pose.position_m + pose.rotation * at;
  }

  void add_body(int k) {
    const sim::TreeBody& body = tree_.bodies[static_cast<std::size_t>(k)];
    const auto before = strokes.size();
    for (const erp::Part& part : body.body.parts)
      std::visit([&](const auto& p) { add_part(k, p); }, part);
    if (strokes.size() == before) add_bones(k);
    for (std::size_t s = before; s < strokes.size(); ++s) strokes[s].title = body.body.name;
    if (body.joint >= 0)
      strokes.push_back({{point(k, Vec3::Zero())},
                         bone_m,
                         joint_fill,
                         joint_fill,
                         tree_.joints[static_cast<std::size_t>(body.joint)].name,
                         1});
  }

  void add_part(int k, const erp::Sphere& s) {
    strokes.push_back({{point(k, vec(s.at_m))}, 2 * s.radius_m, bone_fill, bone_edge, "", 0});
  }
  void add_part(int k, const erp::Capsule& c) {
    strokes.push_back({{point(k, vec(c.from_m)), point(k, vec(c.to_m))},
                       2 * c.radius_m,
                       bone_fill,
                       bone_edge,
                       "",
                       0});
  }
  void add_part(int k, const erp::Box& b) {
    const Vec3 at = vec(b.at_m), half_m = vec(b.size_m) / 2;
    for (int axis = 0; axis < 3; ++axis)
      for (int corner = 0; corner < 4; ++corner) {
        Vec3 from = half_m;
        from[(axis + 1) % 3] *= corner & 1 ? 1 : -1;
        from[(axis + 2) % 3] *= corner & 2 ? 1 : -1;
        Vec3 to = from;
        to[axis] = -to[axis];
        strokes.push_back({{point(k, at + from), point(k, at + to)}, 0, bone_edge, nullptr, "", 0});
      }
  }
  /// Drawn as a ball with the volume of its mass.
  void add_part(int k, const erp::Weight& w) {
    const double radius = std::cbrt(w.mass_kg / weight_kg_per_m3 * 3 / (4 * std::numbers::pi));
    strokes.push_back({{point(k, vec(w.at_m))}, 2 * radius, weight_fill, bone_edge, "", 0});
  }

  /// A body without a shape is drawn as lines from its joint to its centre of mass and to child
  /// joints.
  void add_bones(int k) {
    const sim::TreeBody& body = tree_.bodies[static_cast<std::size_t>(k)];
    if (body.joint < 0) return;
    const auto stick = [&](const Vec3& to) {
      strokes.push_back(
          {{point(k, Vec3::Zero()), point(k, to)}, bone_m, bone_fill, bone_edge, "", 0});
    };
    stick(vec(body.mass.com_m));
    for (const erp::Joint& joint : tree_.joints)
      if (joint.parent == body.body.name) stick(vec(joint.at_m));
  }

  void add_tendon(const erp::Actuator& actuator) {
    const sim::Routing routing(actuator.tendon, tree_.names);
    const sim::PathShape shape = routing.solve(model_.poses());
    for (const sim::PathElement& element : routing.elements())
      if (element.radius_m > 0)
        strokes.push_back({{point(element.body, element.at_m)},
                           2 * element.radius_m,
                           "none",
                           pulley_edge,
                           "",
                           1});
    strokes.push_back(
        {sim::path_line(routing, shape, arc_step_rad), 0, muscle, nullptr, actuator.name, 2});
  }

  sim::RobotTree tree_;
  sim::SkeletonModel model_;
  const erp::Robot& robot_;
};

}  // namespace

std::vector<Stroke> strokes_of(const erp::Robot& robot) { return Scene(robot).strokes; }

}  // namespace formats
