#pragma once
#include <array>
#include <limits>
#include <string>
#include <utility>

/// The vocabulary with which a struct lists its XML: see `interfaces/xml/README.md`.
///
///   void visit(auto& v) {
///     v.required("mass_kg", mass_kg, {xml::positive, "Mass of the body."});    // required attribute
///     v("com_m", com_m, "Centre of mass in the frame of the body.");           // attribute with a default
///     v.child(spindle);                                // exactly one child element
///     v.optional_child(cover);                         // std::optional: one or none
///     v.list(bodies);                                  // std::vector: any number of children
///     v.list(path);                                    // std::vector of std::variant: several kinds
///     v.rest(parameters);                              // all other attributes, unchecked
///   }
namespace xml {

using Vec3 = std::array<double, 3>;

/// Place of an element in its file; the reader fills it for later error messages.
struct Place {
  std::string file;
  int line = 0, column = 0;
};

/// An attribute as written in the file.
struct Attribute {
  Place place;  ///< of the name's first letter
  std::string name, value;
};

/// Valid range of a numeric attribute.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open_min = false, open_max = false;  ///< true: excludes the end itself
  constexpr bool contains(double x) const {
    return (open_min ? x > min : x >= min) && (open_max ? x < max : x <= max);
  }
};
inline constexpr Range any{};
inline constexpr Range positive{0.0, std::numeric_limits<double>::infinity(), true, false};
inline constexpr Range at_least_zero{0.0, std::numeric_limits<double>::infinity(), false, false};

/// Valid range and meaning of an attribute. The meaning is one sentence for the schema and the reference: quantity, sign,
/// frame, source of the default. Name, unit (in the name), type and default are known otherwise.
struct Field {
  Range range{};
  const char* meaning = "";
  constexpr Field() = default;
  constexpr Field(const Range& valid) : range(valid) {}
  constexpr Field(const char* text) : meaning(text) {}
  constexpr Field(const Range& valid, const char* text) : range(valid), meaning(text) {}
};

/// The names of an enum's values in XML: `static constexpr auto list`, pairs of name and value.
template <class Enum>
struct Names;

}  // namespace xml
