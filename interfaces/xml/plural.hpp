#pragma once
#include <vector>

#include "interfaces/xml/fields.hpp"

namespace xml {

/// A list in its own element `One::plural`: `<plans> <plan …/> … </plans>`. For structs that also
/// have single children, because an XSD cannot express both in one element.
template <class One>
struct Plural {
  static constexpr auto element = One::plural;
  static constexpr auto description = "List of the elements in it.";
  Place place;
  std::vector<One> all;
  void visit(auto& v) { v.list(all); }
};

}  // namespace xml
