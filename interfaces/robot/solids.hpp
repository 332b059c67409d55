#pragma once
#include <string>
#include <variant>
#include <vector>

#include "interfaces/xml/fields.hpp"

/// What the bodies of robot.xml consist of. Lengths in metres, in the body's frame.
namespace erp {

using xml::Vec3;

struct Sphere {
  static constexpr auto element = "sphere";
  xml::Place place;
  Vec3 at_m{0, 0, 0};  ///< centre
  double radius_m = 0;
  void visit(auto& v) { v("at_m", at_m), v.required("radius_m", radius_m, xml::positive); }
};

/// A cylinder with round ends: all points within a radius of a line.
struct Capsule {
  static constexpr auto element = "capsule";
  xml::Place place;
  Vec3 from_m{0, 0, 0}, to_m{0, 0, 0};  ///< the ends of that line
  double radius_m = 0;
  void visit(auto& v) {
    v.required("from_m", from_m), v.required("to_m", to_m);
    v.required("radius_m", radius_m, xml::positive);
  }
};

/// Its edges are parallel to the body's axes.
struct Box {
  static constexpr auto element = "box";
  xml::Place place;
  Vec3 at_m{0, 0, 0};    ///< centre
  Vec3 size_m{0, 0, 0};  ///< edges
  void visit(auto& v) { v("at_m", at_m), v.required("size_m", size_m, xml::positive); }
};

/// A mass without size, such as a motor on a bone.
struct Weight {
  static constexpr auto element = "weight";
  xml::Place place;
  Vec3 at_m{0, 0, 0};
  double mass_kg = 0;
  std::string source;
  void visit(auto& v) {
    v.required("at_m", at_m), v.required("mass_kg", mass_kg, xml::positive);
    v("source", source);
  }
};

using Part = std::variant<Sphere, Capsule, Box, Weight>;

}  // namespace erp
