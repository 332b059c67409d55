#pragma once
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "interfaces/robot/solids.hpp"
#include "interfaces/robot/source.hpp"
#include "interfaces/xml/fields.hpp"

/// Bodies and joints of robot.xml.
namespace erp {

/// Its mass is given, or computed from solids and weights: see mass_of.
struct Body {
  static constexpr auto element = "body";
  static constexpr auto description =
      "Rigid body. Its frame is that of the joint that moves it, or the world frame for a root "
      "body, which no joint moves. Its solids are also its shape for contacts, ropes and pictures.";
  xml::Place place;
  std::string name;
  double mass_kg = 0.0;  ///< 0: a root body, fixed to the world
  Vec3 com_m{0, 0, 0};
  Vec3 inertia_kg_m2{0, 0, 0};   ///< xx yy zz
  Vec3 products_kg_m2{0, 0, 0};  ///< xy xz yz, entries of the tensor (−Σ m x y)
  std::optional<double> density_kg_per_m3;
  std::string source;
  std::vector<Part> parts;  ///< solids (also the shape for contacts and pictures) and weights
  void visit(auto& v) {
    v.required("name", name, "Name, unique among bodies.");
    v("mass_kg", mass_kg,
      {xml::at_least_zero,
       "Mass of the body. Omit it for a root body, or if the mass follows from density_kg_per_m3 "
       "or weights."});
    v("com_m", com_m,
      "Centre of mass in the frame of the body. Ignored if the mass follows from density or "
      "weights.");
    v("inertia_kg_m2", inertia_kg_m2,
      {xml::at_least_zero,
       "Moments of inertia xx, yy, zz about the centre of mass, in the axes of the body. Ignored "
       "if the mass follows from density or weights."});
    v("products_kg_m2", products_kg_m2,
      "Off-diagonal entries xy, xz, yz of the inertia tensor (−Σ m x y, …) about the centre of "
      "mass, in the axes of the body. Ignored if the mass follows from density or weights.");
    v("density_kg_per_m3", density_kg_per_m3,
      {xml::positive,
       "Density of its solids. If given, or if the body has weights, mass, centre of mass and "
       "inertia are computed from solids and weights; overlaps of solids count twice."});
    v("source", source, source_description);
    v.list(parts);
  }
};

enum class JointType { revolute, spherical, fixed, free };

struct Joint {
  static constexpr auto element = "joint";
  static constexpr auto description =
      "Joint between two bodies. Joints form a tree; each body is moved by at most one. The frames "
      "of parent and child are parallel at angle zero.";
  xml::Place place;
  std::string name;
  JointType type = JointType::revolute;
  std::string parent, child;
  Vec3 at_m{0, 0, 0};
  Vec3 axis{0, 1, 0};
  double min_rad = -3.14159, max_rad = 3.14159;
  double initial_rad = 0.0;
  double viscous_Nm_s_per_rad = 0.0, coulomb_Nm = 0.0;
  std::string source;
  void visit(auto& v) {
    v.required("name", name, "Name, unique among joints.");
    v.required("type", type,
               "revolute: one axis; spherical: three; fixed: none; free: the child moves freely "
               "relative to a root body, so that only gravity, tendons and contacts act on it.");
    v.required("parent", parent,
               "Name of the body that carries the joint; a root body for a free joint.");
    v.required("child", child, "Name of the body that the joint moves.");
    v("at_m", at_m,
      "Position of the joint in the frame of the parent; origin of the frame of the child, for a "
      "free joint in the starting pose.");
    v("axis", axis,
      "Axis of a revolute joint in the frame of the parent; positive angles turn the child "
      "right-handed about it. Its magnitude has no effect.");
    v("min_rad", min_rad, "Lower stop of a revolute joint.");
    v("max_rad", max_rad,
      "Upper stop of a revolute joint; of a spherical joint, largest rotation from the starting "
      "pose, about any axis.");
    v("initial_rad", initial_rad,
      "Angle of a revolute joint in the starting pose. Spherical and free joints start with "
      "parallel frames.");
    v("viscous_Nm_s_per_rad", viscous_Nm_s_per_rad,
      {xml::at_least_zero,
       "Viscous friction coefficient; of a spherical joint, about any axis. Not for free joints."});
    v("coulomb_Nm", coulomb_Nm,
      {xml::at_least_zero,
       "Coulomb friction torque, at rest and in motion; of a spherical joint, against the angular "
       "velocity about any axis. Not for free joints."});
    v("source", source, source_description);
  }
};

struct Contact {
  static constexpr auto element = "contact";
  static constexpr auto description =
      "Pair of bodies that cannot penetrate each other: their solids collide without friction or "
      "restitution. Other pairs pass through each other.";
  xml::Place place;
  std::string body, on;
  void visit(auto& v) {
    v.required("body", body, "Name of a body with at least one solid.");
    v.required("on", on,
               "Name of the other body, which also has a solid. At least one of both is moved by a "
               "joint.");
  }
};

struct Skeleton {
  static constexpr auto element = "skeleton";
  static constexpr auto description = "Bodies and joints of the robot, or of one of its parts.";
  xml::Place place;
  std::optional<Vec3> gravity_m_per_s2;  ///< in one part of a robot only
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<Contact> contacts;
  void visit(auto& v) {
    v("gravity_m_per_s2", gravity_m_per_s2,
      "Acceleration of gravity in the world frame. Given in one part of a robot only; default: no "
      "gravity.");
    v.list(bodies);
    v.list(joints);
    v.list(contacts);
  }
};

}  // namespace erp

template <>
struct xml::Names<erp::JointType> {
  static constexpr auto list = std::to_array<std::pair<const char*, erp::JointType>>(
      {{"revolute", erp::JointType::revolute},
       {"spherical", erp::JointType::spherical},
       {"fixed", erp::JointType::fixed},
       {"free", erp::JointType::free}});
};
