#include <cmath>
#include <variant>

#include "interfaces/robot/check.hpp"
#include "interfaces/xml/values.hpp"

namespace erp::robot_check {
namespace {

using xml::quote;
using xml::write_number;

/// Distance from the sphere's centre or the cylinder's axis.
double distance_m(const Vec3& point, const Pulley& pulley) {
  Vec3 from{};
  for (std::size_t i = 0; i < 3; ++i) from[i] = point[i] - pulley.center_m[i];
  if (pulley.shape == PulleyShape::cylinder && pulley.axis) {
    const Vec3& a = *pulley.axis;
    const double size2 = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
    const double along = (from[0] * a[0] + from[1] * a[1] + from[2] * a[2]) / size2;
    for (std::size_t i = 0; i < 3 && size2 > 0; ++i) from[i] -= along * a[i];
  }
  return std::hypot(from[0], from[1], from[2]);
}

bool is_attach(const std::variant<Attach, Pulley>& point) {
  return std::holds_alternative<Attach>(point);
}

void check_ends(const Actuator& actuator, Findings& findings) {
  const auto& path = actuator.tendon.path;
  if (path.size() > max_path_elements)
    findings.add(actuator.tendon, "the path has " + std::to_string(path.size()) + " points",
                 "give at most " + std::to_string(max_path_elements));
  if (path.size() < 2)
    findings.add(actuator.tendon, "the path has " + std::to_string(path.size()) + " points",
                 "it needs at least two <attach>: the motor's end and the distal end");
  else if (!is_attach(path.front()) || !is_attach(path.back()))
    findings.add(actuator.tendon, "the path begins or ends with a <pulley>",
                 "begin and end it with an <attach>");
}

/// There is no tangent from a point inside a sphere to the sphere. Checks points and pulleys on the
/// same body only; the simulator reports a point that enters a pulley of another body.
void check_inside(const Attach& point, const Pulley& pulley, Findings& findings) {
  const double apart_m = distance_m(point.at_m, pulley);
  if (point.body != pulley.body || apart_m >= pulley.radius_m) return;
  findings.add(point,
               "at_m=" + quote(xml::Codec<Vec3>::write(point.at_m)) + " lies " +
                   write_number(apart_m) +
                   " m from the centre of the neighbouring pulley, "
                   "inside its radius_m=" +
                   quote(write_number(pulley.radius_m)),
               "move it out, or make the pulley smaller");
}

void check_neighbours(const Actuator& actuator, Findings& findings) {
  const auto& path = actuator.tendon.path;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const auto *here = &path[i], *next = &path[i + 1];
    if (is_attach(*next)) std::swap(here, next);
    if (is_attach(*here) && !is_attach(*next))
      check_inside(std::get<Attach>(*here), std::get<Pulley>(*next), findings);
  }
}

/// Checks that a pulley with a cylinder or with turns has an axis.
void check_pulleys(const Actuator& actuator, Findings& findings) {
  for (const auto& point : actuator.tendon.path) {
    const auto* pulley = std::get_if<Pulley>(&point);
    if (!pulley) continue;
    const bool zero = pulley->axis && *pulley->axis == Vec3{0, 0, 0};
    if (zero) findings.add(*pulley, "axis=\"0 0 0\" has no direction", "give a direction");
    if (!pulley->axis && pulley->shape == PulleyShape::cylinder)
      findings.add(*pulley, "a cylinder without an axis",
                   "add axis=\"…\": the tendon runs around it right-handed");
    if (!pulley->axis && pulley->turns > 0)
      findings.add(*pulley, "turns without an axis", "add axis=\"…\" to define their direction");
    if (pulley->axis && pulley->side != Vec3{0, 0, 0})
      findings.add(*pulley, "both axis and side", "axis already defines the side: remove side");
  }
}

/// A rope takes its path over the solids by collision: it has no via points and no counted turns.
void check_rope(const Actuator& actuator, Findings& findings) {
  if (!actuator.rope) return;
  const auto& path = actuator.tendon.path;
  for (std::size_t k = 1; k + 1 < path.size(); ++k)
    if (is_attach(path[k]))
      findings.add(std::get<Attach>(path[k]), "a rope supports no <attach> between its ends",
                   "remove it, or the <rope>");
  for (const auto& point : path)
    if (const auto* pulley = std::get_if<Pulley>(&point); pulley && pulley->axis)
      findings.add(*pulley, "a rope supports neither turns nor cylinders",
                   "remove axis, or the <rope>");
}

void check_limits(const Robot& robot, const Actuator& actuator, Findings& findings) {
  const auto exceeds = [&](const char* name, double value_N, double limit_N, const char* limit) {
    if (value_N > limit_N)
      findings.add(actuator,
                   std::string(name) + "=" + quote(write_number(value_N)) + " exceeds " + limit +
                       "=" + quote(write_number(limit_N)),
                   "give at most " + write_number(limit_N));
  };
  exceeds("relax_tension_N", actuator.relax_tension_N, actuator.max_tension_N, "max_tension_N");
  exceeds("pretension_N", actuator.tendon.pretension_N, actuator.max_tension_N, "max_tension_N");
  for (const SensorType& type : robot.sensor_types)
    if (type.name == actuator.sensors)
      exceeds("max_tension_N", actuator.max_tension_N, type.tension_range_N,
              "the sensor's tension_range_N");
}

}  // namespace

void check_tendons(const Robot& robot, Findings& findings) {
  for (const Actuator& actuator : robot.actuators) {
    check_ends(actuator, findings);
    check_neighbours(actuator, findings);
    check_pulleys(actuator, findings);
    check_rope(actuator, findings);
    check_limits(robot, actuator, findings);
  }
}

}  // namespace erp::robot_check
