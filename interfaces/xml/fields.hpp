#pragma once
#include <array>
#include <limits>
#include <string>
#include <utility>

/// Types with which a struct lists its XML attributes and children: see `interfaces/xml/README.md`.
///
///   void visit(auto& v) {
///     v.required("mass_kg", mass_kg, {xml::positive, "Mass of the body."});  // required attribute
///     v("com_m", com_m, "Centre of mass in the frame of the body.");  // attribute with a default
///     v.child(spindle);                         // exactly one child element
///     v.optional_child(cover);                  // std::optional: one or none
///     v.list(bodies);                           // std::vector: any number of children
///     v.list(path);                             // std::vector of std::variant: several types
///     v.rest(parameters);                       // all other attributes, unchecked
///   }
namespace xml {

using Vec3 = std::array<double, 3>;

/// Place of an element in its file, for error messages; the reader fills it.
struct Place {
  std::string file;
  int line = 0, column = 0;
};

/// An attribute as written in the file.
struct Attribute {
  Place place;  ///< of the first letter of its name
  std::string name, value;
};

/// Valid range of a numeric attribute.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open_min = false, open_max = false;  ///< true: the limit itself is excluded
  constexpr bool contains(double x) const {
    return (open_min ? x > min : x >= min) && (open_max ? x < max : x <= max);
  }
};
inline constexpr Range any{};
inline constexpr Range positive{0.0, std::numeric_limits<double>::infinity(), true, false};
inline constexpr Range at_least_zero{0.0, std::numeric_limits<double>::infinity(), false, false};

/// Valid range and description of an attribute. The description is one sentence for the schema and
/// the reference: quantity, sign, frame, source of the default. Name, unit, type and default are
/// shown beside it.
struct Field {
  Range range{};
  const char* description = "";
  constexpr Field() = default;
  constexpr Field(const Range& valid) : range(valid) {}
  constexpr Field(const char* text) : description(text) {}
  constexpr Field(const Range& valid, const char* text) : range(valid), description(text) {}
};

/// Names of the values of an enum in XML: a specialization has `static constexpr auto list`, pairs
/// of name and value.
template <class Enum>
struct Names;

}  // namespace xml
