#pragma once
#include <string>
#include <vector>

#include "interfaces/xml/describe.hpp"

/// Elements and attributes that a struct lists without a description, as "element attribute".
/// `root`: name of its element.
template <class T>
std::vector<std::string> without_description(const std::string& root) {
  std::vector<xml::Description> descriptions;
  T defaults{};
  xml::Describer describer(descriptions);
  defaults.visit(describer);
  std::vector<std::string> names;
  std::string element = root;
  for (const auto& d : descriptions) {
    if (d.is_element) element = d.name;
    if (d.description.empty()) names.push_back(element + " " + d.name);
  }
  return names;
}
