#pragma once
#include <array>
#include <limits>
#include <string>
#include <utility>

/// The vocabulary in which a struct lists its XML: see `interfaces/xml/README.md`.
///
///   void visit(auto& v) {
///     v.required("mass_kg", mass_kg, xml::positive);   // attribute that must stand there
///     v("com_m", com_m);                               // attribute with a default
///     v.child(spindle);                                // exactly one child element
///     v.optional_child(cover);                         // std::optional: one or none
///     v.list(bodies);                                  // std::vector: any number of children
///     v.list(path);                                    // std::vector of std::variant: of several
///     kinds
///     v.rest(parameters);                              // attributes not named above, as they
///     stand
///   }
namespace xml {

using Vec3 = std::array<double, 3>;

/// Where an element stands; filled by the reader, for errors about what it says.
struct Place {
  std::string file;
  int line = 0, column = 0;
};

/// An attribute as it stands in the file.
struct Attribute {
  Place place;  ///< of the name's first letter
  std::string name, value;
};

/// Which numbers an attribute may take.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open_min = false, open_max = false;  ///< true: the end itself is refused
  constexpr bool contains(double x) const {
    return (open_min ? x > min : x >= min) && (open_max ? x < max : x <= max);
  }
};
inline constexpr Range any{};
inline constexpr Range positive{0.0, std::numeric_limits<double>::infinity(), true, false};
inline constexpr Range at_least_zero{0.0, std::numeric_limits<double>::infinity(), false, false};

/// The words an enum is written with: `static constexpr auto list`, pairs of word and value.
template <class Enum>
struct Names;

}  // namespace xml
