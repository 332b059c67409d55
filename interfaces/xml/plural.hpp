#pragma once
#include <vector>

#include "interfaces/xml/fields.hpp"

namespace xml {

/// A list in an element of its own, for structs that also have single children: an XSD cannot express
/// both in one element:  `<plans> <plan …/> … </plans>`.  One::plural is its name.
template <class One>
struct Plural {
  static constexpr auto element = One::plural;
  static constexpr auto meaning = "List of the elements in it.";
  Place place;
  std::vector<One> all;
  void visit(auto& v) { v.list(all); }
};

}  // namespace xml
