#pragma once
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "interfaces/robot/source.hpp"
#include "interfaces/values.hpp"
#include "interfaces/xml/fields.hpp"

/// Tendons of robot.xml: path, spring, line and spindle.
namespace erp {

using xml::Vec3;

struct Attach {
  static constexpr auto element = "attach";
  static constexpr auto description =
      "Point of a tendon that is fixed to a body. The first is the motor's end and the last the "
      "distal end; the tendon passes through those between without friction.";
  xml::Place place;
  std::string body;
  Vec3 at_m{0, 0, 0};
  void visit(auto& v) {
    v.required("body", body,
               "Name of the body that carries the point and takes the force of the tendon there.");
    v.required("at_m", at_m, "Position in the frame of the body.");
  }
};

enum class PulleyShape { sphere, cylinder };

struct Pulley {
  static constexpr auto element = "pulley";
  static constexpr auto description =
      "Sphere or infinite cylinder without friction, fixed to a body. The tendon wraps around it "
      "where it crosses the straight path.";
  xml::Place place;
  std::string body;
  Vec3 center_m{0, 0, 0};
  double radius_m = 0;
  Vec3 side{0, 0, 0};  ///< zero: the shorter path
  PulleyShape shape = PulleyShape::sphere;
  std::optional<Vec3> axis;
  int turns = 0;
  void visit(auto& v) {
    v.required("body", body,
               "Name of the body that carries the pulley and takes the force of the tendon there.");
    v("shape", shape,
      "sphere: the tendon runs in the plane of the centre and the neighboring points of the path. "
      "cylinder: it runs around axis, as a helix if these points are offset along axis.");
    v.required(
        "center_m", center_m,
        "Centre of the sphere, or a point on the axis of the cylinder, in the frame of the body.");
    v.required("radius_m", radius_m,
               {xml::positive,
                "Radius of the circle on which the line runs; with a <rope>, of the surface of the "
                "pulley. Neighboring points of the path must stay outside."});
    v("side", side,
      "For a sphere: direction, in the frame of the body, from the centre to the side on which the "
      "tendon passes, also for more than half a turn. Default: the shorter path. Excludes axis.");
    v("axis", axis,
      "Direction, in the frame of the body, around which the tendon runs right-handed from the "
      "motor's end to the distal end; whole turns are then counted. Required for a cylinder; its "
      "magnitude has no effect.");
    v("turns", turns,
      {xml::Range{0, 20},
       "Whole turns around axis in the starting pose, in addition to a path of less than one turn. "
       "Requires axis if not 0."});
  }
};

struct Tendon {
  static constexpr auto element = "tendon";
  static constexpr auto description =
      "Series elastic tendon, eqs 1 and 2: F = κ x + κ₃ x³ + D dx/dt for the stretch x, never "
      "negative, 0 if slack. Its path is listed from the motor's end to the distal end.";
  xml::Place place;
  double stiffness_N_per_m = 0, damping_N_s_per_m = 0;  ///< κ, D
  double cubic_N_per_m3 = 0;                            ///< κ₃
  std::optional<double> line_stiffness_N_per_m;  ///< in series with the spring; absent: rigid
  double pretension_N = 0;
  std::string source;
  std::vector<std::variant<Attach, Pulley>> path;  ///< from the motor's end to the distal end
  void visit(auto& v) {
    v.required(
        "stiffness_N_per_m", stiffness_N_per_m,
        {xml::positive, "Stiffness κ of the spring; for a tendon without a spring, of the line."});
    v("damping_N_s_per_m", damping_N_s_per_m,
      {xml::at_least_zero, "Damping D: tension per rate of stretch. A slack tendon has none."});
    v("cubic_N_per_m3", cubic_N_per_m3,
      {xml::at_least_zero,
       "Cubic stiffness κ₃ of a spring that stiffens as it is stretched. Default: linear spring."});
    v("line_stiffness_N_per_m", line_stiffness_N_per_m,
      {xml::positive,
       "Stiffness of the line in series with the spring. Default: inextensible line."});
    v("pretension_N", pretension_N,
      {xml::at_least_zero,
       "Tension in the starting pose before the motor turns; it determines the line length L_K0 at "
       "the start. A <pretension> of the robot replaces it."});
    v("source", source, source_description);
    v.list(path);
  }
};

struct Spindle {
  static constexpr auto element = "spindle";
  static constexpr auto description = "Spindle on the gearbox output, which winds up the line.";
  xml::Place place;
  double radius_m = 0;
  void visit(auto& v) {
    v.required("radius_m", radius_m,
               {xml::positive,
                "Radius r at which the line is wound: line length per radian of the gearbox "
                "output, and torque per tension."});
  }
};

struct Rope {
  static constexpr auto element = "rope";
  static constexpr auto description =
      "Simulates the tendon as a chain of nodes that collides with solids and pulleys (the paper's "
      "physical tendon), instead of a massless line on the shortest path. Excludes an <attach> "
      "between the ends, and pulleys with an axis.";
  xml::Place place;
  int nodes = 20;
  double mass_kg = 0, radius_m = 0;
  double friction = 0;
  std::string source;
  void visit(auto& v) {
    v("nodes", nodes,
      {xml::Range{4, 200},
       "Number of segments between the ends. A segment may be as long as radius_m plus the "
       "smallest radius or half edge of the solids and pulleys; the error states the number "
       "required."});
    v.required("mass_kg", mass_kg,
               {xml::positive, "Mass of the whole rope, distributed equally among its nodes."});
    v.required("radius_m", radius_m,
               {xml::at_least_zero,
                "Half thickness: distance of the nodes from the surface that they touch."});
    v("friction", friction,
      {xml::Range{0, 2},
       "Coulomb friction coefficient µ between rope and solids or pulleys. Default: no friction."});
    v("source", source, source_description);
  }
};

}  // namespace erp

template <>
struct xml::Names<erp::PulleyShape> {
  static constexpr auto list = std::to_array<std::pair<const char*, erp::PulleyShape>>(
      {{"sphere", erp::PulleyShape::sphere}, {"cylinder", erp::PulleyShape::cylinder}});
};
