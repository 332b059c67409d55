#include "interfaces/xml/reader.hpp"

#include <algorithm>

namespace xml {
namespace {

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Attributes with which an editor finds the XSD; allowed in every element and ignored.
bool belongs_to_editors(const std::string& name) {
  return name == "xmlns:xsi" || name == "xsi:noNamespaceSchemaLocation";
}

}  // namespace

const Attribute* Reader::exact_attribute(const std::string& name) const {
  for (const Attribute& a : element_.attributes)
    if (a.name == name) return &a;
  return nullptr;
}

const Attribute* Reader::find_attribute(const std::string& name) {
  if (const Attribute* attribute = exact_attribute(name)) return attribute;
  for (const auto& [former, current] : former_names_) {
    if (current != name) continue;
    const Attribute* attribute = exact_attribute(former);
    if (!attribute) continue;
    warn_renamed(attribute->place, former, current);
    known_attributes_.push_back(former);
    return attribute;
  }
  return nullptr;
}

void Reader::add_second_element_error(const Element& child, const Element& first) {
  errors_.push_back(error_in(element_.name, child.place, "a second <" + child.name + ">",
                             "keep one; the first is in line " + std::to_string(first.place.line)));
}

void Reader::add_value_error(const Attribute& attribute, const ValueError& error) {
  errors_.push_back(error_in(element_.name, attribute.place,
                             attribute.name + "=" + quote(attribute.value) + " " + error.what,
                             error.remedy));
}

void Reader::rest(std::vector<Attribute>& values) {
  for (const Attribute& a : element_.attributes)
    if (!has(known_attributes_, a.name) && !belongs_to_editors(a.name)) {
      values.push_back(a);
      known_attributes_.push_back(a.name);
    }
}

/// Reports an unknown name. Removes the nearest known name from the missing ones: a misspelt name
/// then gives one error, not two.
void Reader::add_unknown_name_error(const std::string& kind, const Place& place,
                                    const std::string& name, const std::vector<std::string>& known,
                                    std::vector<std::string>& missing) {
  std::erase(missing, nearest(name, known));
  errors_.push_back(error_in(element_.name, place, "unknown " + kind + " " + quote(name),
                             did_you_mean(name, known)));
}

void Reader::finish() {
  for (const Attribute& a : element_.attributes)
    if (!has(known_attributes_, a.name) && !belongs_to_editors(a.name))
      add_unknown_name_error("attribute", a.place, a.name, known_attributes_, missing_attributes_);
  for (const Element& child : element_.children)
    if (!has(known_children_, child.name))
      add_unknown_name_error("element", child.place, child.name, known_children_,
                             missing_children_);
  for (const auto& [place, text] : element_.stray_text)
    errors_.push_back(error_in(element_.name, place, "stray text " + quote(text),
                               "remove it, or put it into a comment"));
  for (const std::string& name : missing_attributes_)
    errors_.push_back(error_in(element_.name, element_.place,
                               "attribute " + quote(name) + " is missing",
                               "add " + name + "=\"…\""));
  for (const std::string& name : missing_children_)
    errors_.push_back(
        error_in(element_.name, element_.place, "element <" + name + "> is missing", "add one"));
}

}  // namespace xml
