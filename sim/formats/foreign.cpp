#include "sim/formats/foreign.hpp"

#include <algorithm>

#include "interfaces/xml/values.hpp"

namespace formats {

std::vector<Foreign> Foreign::all(const std::string& tag) const {
  std::vector<Foreign> match;
  for (const xml::Element& child : element_->children)
    if (child.name == tag) match.emplace_back(child);
  return match;
}

std::optional<Foreign> Foreign::one(const std::string& tag) const {
  const auto match = all(tag);
  return match.empty() ? std::nullopt : std::optional(match.front());
}

Foreign Foreign::need(const std::string& tag) const {
  if (const auto child = one(tag)) return *child;
  reject("has no <" + tag + ">", "add one");
}

std::optional<std::string> Foreign::attribute(const std::string& name) const {
  const auto match = std::ranges::find(element_->attributes, name, &xml::Attribute::name);
  if (match == element_->attributes.end()) return {};
  return match->value;
}

std::string Foreign::name() const {
  if (const auto value = attribute("name")) return *value;
  reject("has no name", "add name=\"…\"");
}

std::string Foreign::text() const {
  std::string text;
  for (const auto& [place, words] : element_->stray_text) text += words;
  return std::string(xml::trimmed(text));
}

std::vector<double> Foreign::numbers(const std::string& name, std::size_t count) const {
  const auto text = attribute(name);
  if (!text) reject("has no " + name, "add " + name + "=\"…\"");
  return parsed(*text, count, name + "=");
}

std::vector<double> Foreign::numbers(std::size_t count) const { return parsed(text(), count, ""); }

double Foreign::number_in(const std::string& child, double default_value) const {
  const auto match = one(child);
  return match ? match->number() : default_value;
}

std::vector<double> Foreign::parsed(const std::string& text, std::size_t count,
                                    const std::string& what) const {
  std::vector<double> values;
  for (const std::string_view word : xml::split(text)) {
    double value = 0;
    if (const auto error = xml::read_number(word, value, xml::any))
      reject(what + xml::quote(text) + " " + error->what, error->remedy);
    values.push_back(value);
  }
  if (values.size() != count)
    reject(what + xml::quote(text) + " contains " + std::to_string(values.size()) + " numbers",
           "give " + std::to_string(count));
  return values;
}

void Foreign::reject(const std::string& what, const std::string& remedy) const {
  throw xml::Errors({xml::error_in(element_->name, element_->place, what, remedy)});
}

}  // namespace formats
