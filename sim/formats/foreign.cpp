#include "sim/formats/foreign.hpp"

#include <algorithm>

#include "interfaces/xml/values.hpp"

namespace formats {

std::vector<Foreign> Foreign::all(const std::string& tag) const {
  std::vector<Foreign> found;
  for (const xml::Element& child : element_->children)
    if (child.name == tag) found.emplace_back(child);
  return found;
}

std::optional<Foreign> Foreign::one(const std::string& tag) const {
  const auto found = all(tag);
  return found.empty() ? std::nullopt : std::optional(found.front());
}

Foreign Foreign::need(const std::string& tag) const {
  if (const auto child = one(tag)) return *child;
  refuse("has no <" + tag + ">", "add one");
}

std::optional<std::string> Foreign::attribute(const std::string& name) const {
  const auto found = std::ranges::find(element_->attributes, name, &xml::Attribute::name);
  if (found == element_->attributes.end()) return {};
  return found->value;
}

std::string Foreign::name() const {
  if (const auto given = attribute("name")) return *given;
  refuse("has no name", "add name=\"…\"");
}

std::string Foreign::text() const {
  std::string text;
  for (const auto& [place, words] : element_->stray_text) text += words;
  return std::string(xml::trimmed(text));
}

std::vector<double> Foreign::numbers(const std::string& name, std::size_t count) const {
  const auto text = attribute(name);
  if (!text) refuse("has no " + name, "add " + name + "=\"…\"");
  return parsed(*text, count, name + "=");
}

std::vector<double> Foreign::numbers(std::size_t count) const { return parsed(text(), count, ""); }

double Foreign::number_in(const std::string& child, double default_value) const {
  const auto found = one(child);
  return found ? found->number() : default_value;
}

std::vector<double> Foreign::parsed(const std::string& text, std::size_t count,
                                    const std::string& what) const {
  std::vector<double> values;
  for (const std::string_view word : xml::split(text)) {
    double value = 0;
    if (const auto refused = xml::read_number(word, value, xml::any))
      refuse(what + xml::quote(text) + " " + refused->what, refused->remedy);
    values.push_back(value);
  }
  if (values.size() != count)
    refuse(what + xml::quote(text) + " contains " + std::to_string(values.size()) + " numbers",
           "give " + std::to_string(count));
  return values;
}

void Foreign::refuse(const std::string& what, const std::string& remedy) const {
  throw xml::Errors({xml::error_in(element_->name, element_->place, what, remedy)});
}

}  // namespace formats
