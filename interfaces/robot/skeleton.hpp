#pragma once
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "interfaces/robot/solids.hpp"
#include "interfaces/xml/fields.hpp"

/// Bodies and joints of robot.xml.
namespace erp {

/// A rigid body. Its frame is the frame of the joint that moves it (world for a root body).
/// Its mass is given, or follows from the density of the solids it consists of and from its
/// weights: see mass_of.
struct Body {
  static constexpr auto element = "body";
  xml::Place place;
  std::string name;
  double mass_kg = 0.0;          ///< 0: a root body, fixed to the world
  Vec3 com_m{0, 0, 0};           ///< centre of mass in the body frame
  Vec3 inertia_kg_m2{0, 0, 0};   ///< about the centre of mass, body axes: xx yy zz
  Vec3 products_kg_m2{0, 0, 0};  ///< xy xz yz, as they stand in the tensor (−Σ m x y)
  std::optional<double> density_kg_per_m3;
  std::string source;
  std::vector<Part> parts;  ///< solids: its shape, for contacts and pictures too; and weights
  void visit(auto& v) {
    v.required("name", name);
    v("mass_kg", mass_kg, xml::at_least_zero);
    v("com_m", com_m);
    v("inertia_kg_m2", inertia_kg_m2, xml::at_least_zero);
    v("products_kg_m2", products_kg_m2);
    v("density_kg_per_m3", density_kg_per_m3, xml::positive);
    v("source", source);
    v.list(parts);
  }
};

/// `free`: the child floats, held by nothing but its tendons and contacts; its parent is a root.
enum class JointType { revolute, spherical, fixed, free };

/// A joint; parent and child frames are parallel at zero. Positive angle: right-handed about
/// `axis`.
struct Joint {
  static constexpr auto element = "joint";
  xml::Place place;
  std::string name;
  JointType type = JointType::revolute;
  std::string parent, child;
  Vec3 at_m{0, 0, 0};  ///< in the parent's frame
  Vec3 axis{0, 1, 0};  ///< revolute only; a direction of any length but zero
  double min_rad = -3.14159, max_rad = 3.14159;
  double initial_rad = 0.0;
  double viscous_Nm_s_per_rad = 0.0, coulomb_Nm = 0.0;
  std::string source;
  void visit(auto& v) {
    v.required("name", name);
    v.required("type", type);
    v.required("parent", parent);
    v.required("child", child);
    v("at_m", at_m);
    v("axis", axis);
    v("min_rad", min_rad);
    v("max_rad", max_rad);
    v("initial_rad", initial_rad);
    v("viscous_Nm_s_per_rad", viscous_Nm_s_per_rad, xml::at_least_zero);
    v("coulomb_Nm", coulomb_Nm, xml::at_least_zero);
    v("source", source);
  }
};

/// Two bodies that cannot pass through each other. They glide: there is no friction between them.
struct Contact {
  static constexpr auto element = "contact";
  xml::Place place;
  std::string body, on;
  void visit(auto& v) { v.required("body", body), v.required("on", on); }
};

struct Skeleton {
  static constexpr auto element = "skeleton";
  xml::Place place;
  std::optional<Vec3> gravity_m_per_s2;  ///< given once among all parts of a robot; absent: none
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<Contact> contacts;
  void visit(auto& v) {
    v("gravity_m_per_s2", gravity_m_per_s2);
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
