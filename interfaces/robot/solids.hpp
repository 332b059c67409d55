#pragma once
#include <string>
#include <variant>
#include <vector>

#include "interfaces/robot/source.hpp"
#include "interfaces/xml/fields.hpp"

/// Solids and weights of the bodies of robot.xml. Lengths in metres, in the body's frame.
namespace erp {

using xml::Vec3;

struct Sphere {
  static constexpr auto element = "sphere";
  static constexpr auto description = "Solid sphere.";
  xml::Place place;
  Vec3 at_m{0, 0, 0};
  double radius_m = 0;
  void visit(auto& v) {
    v("at_m", at_m, "Centre in the frame of the body.");
    v.required("radius_m", radius_m, {xml::positive, "Radius."});
  }
};

struct Capsule {
  static constexpr auto element = "capsule";
  static constexpr auto description =
      "Solid cylinder with hemispherical ends: all points within radius_m of a line segment.";
  xml::Place place;
  Vec3 from_m{0, 0, 0}, to_m{0, 0, 0};
  double radius_m = 0;
  void visit(auto& v) {
    v.required(
        "from_m", from_m,
        "One end of the line segment, in the frame of the body; the hemisphere extends beyond it.");
    v.required("to_m", to_m, "Other end of the line segment, in the frame of the body.");
    v.required("radius_m", radius_m, {xml::positive, "Radius of the cylinder and of its ends."});
  }
};

struct Box {
  static constexpr auto element = "box";
  static constexpr auto description = "Solid box with edges parallel to the axes of the body.";
  xml::Place place;
  Vec3 at_m{0, 0, 0};
  Vec3 size_m{0, 0, 0};
  void visit(auto& v) {
    v("at_m", at_m, "Centre in the frame of the body.");
    v.required("size_m", size_m, {xml::positive, "Full lengths of the edges along x, y and z."});
  }
};

struct Weight {
  static constexpr auto element = "weight";
  static constexpr auto description =
      "Point mass, such as a motor on a bone. A body with a weight takes its mass from its solids "
      "and weights.";
  xml::Place place;
  Vec3 at_m{0, 0, 0};
  double mass_kg = 0;
  std::string source;
  void visit(auto& v) {
    v.required("at_m", at_m, "Position in the frame of the body.");
    v.required("mass_kg", mass_kg, {xml::positive, "Mass, added to that of the solids."});
    v("source", source, source_description);
  }
};

using Part = std::variant<Sphere, Capsule, Box, Weight>;

}  // namespace erp
