#include <cmath>
#include <variant>

#include "interfaces/robot/check.hpp"
#include "interfaces/xml/values.hpp"

namespace erp::robot_check {
namespace {

using xml::quote;
using xml::write_number;

/// Distance of a point from the centre of a sphere or from the axis of a cylinder.
double distance_from_pulley_m(const Vec3& point, const Pulley& pulley) {
  Vec3 offset_m{};
  for (std::size_t i = 0; i < 3; ++i) offset_m[i] = point[i] - pulley.center_m[i];
  if (pulley.shape == PulleyShape::cylinder && pulley.axis) {
    const Vec3& a = *pulley.axis;
    const double axis_norm2 = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
    const double axial_part =
        (offset_m[0] * a[0] + offset_m[1] * a[1] + offset_m[2] * a[2]) / axis_norm2;
    for (std::size_t i = 0; i < 3 && axis_norm2 > 0; ++i) offset_m[i] -= axial_part * a[i];
  }
  return std::hypot(offset_m[0], offset_m[1], offset_m[2]);
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

/// A point inside a pulley has no tangent to it. Checks only points and pulleys on the same body;
/// the simulator reports a point that enters a pulley on another body.
void check_inside(const Attach& point, const Pulley& pulley, Findings& findings) {
  const double distance_m = distance_from_pulley_m(point.at_m, pulley);
  if (point.body != pulley.body || distance_m >= pulley.radius_m) return;
  findings.add(point,
               "at_m=" + quote(xml::Codec<Vec3>::write(point.at_m)) + " lies " +
                   write_number(distance_m) +
                   " m from the centre of the neighbouring pulley, "
                   "inside its radius_m=" +
                   quote(write_number(pulley.radius_m)),
               "move it out, or make the pulley smaller");
}

void check_neighbours(const Actuator& actuator, Findings& findings) {
  const auto& path = actuator.tendon.path;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const auto *point = &path[i], *neighbour = &path[i + 1];
    if (is_attach(*neighbour)) std::swap(point, neighbour);
    if (is_attach(*point) && !is_attach(*neighbour))
      check_inside(std::get<Attach>(*point), std::get<Pulley>(*neighbour), findings);
  }
}

/// Checks that a pulley with a cylinder or with turns has an axis.
void check_pulleys(const Actuator& actuator, Findings& findings) {
  for (const auto& point : actuator.tendon.path) {
    const auto* pulley = std::get_if<Pulley>(&point);
    if (!pulley) continue;
    const bool has_zero_axis = pulley->axis && *pulley->axis == Vec3{0, 0, 0};
    if (has_zero_axis) findings.add(*pulley, "axis=\"0 0 0\" has no direction", "give a direction");
    if (!pulley->axis && pulley->shape == PulleyShape::cylinder)
      findings.add(*pulley, "a cylinder without an axis",
                   "add axis=\"…\": the tendon runs around it right-handed");
    if (!pulley->axis && pulley->turns > 0)
      findings.add(*pulley, "turns without an axis", "add axis=\"…\" to define their direction");
    if (pulley->axis && pulley->side != Vec3{0, 0, 0})
      findings.add(*pulley, "both axis and side", "axis already defines the side: remove side");
  }
}

/// Collisions with the solids determine the path of a rope: it has no points between its ends and
/// no counted turns.
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
