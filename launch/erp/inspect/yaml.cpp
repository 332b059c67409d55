#include "launch/erp/inspect/yaml.hpp"

#include <algorithm>

#include "launch/erp/inspect/value_names.hpp"

namespace launch {
namespace {

bool holds_structures(const recording::Values& values) {
  return !values.empty() && values.front().members() != nullptr;
}

/// A value on one line; quotes text that YAML would read as another type.
std::string scalar(const recording::Value& value) {
  const std::string* text = value.text();
  if (!text) return recording::to_text(value);
  const auto is_unquoted = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.' || c == ' ' || c == '/' || static_cast<unsigned char>(c) >= 0x80;
  };
  const auto is_letter = [](char c) { return (c | 0x20) >= 'a' && (c | 0x20) <= 'z'; };
  const bool is_reserved = *text == "true" || *text == "false" || *text == "null" ||
                           *text == "yes" || *text == "no" || *text == "on" || *text == "off";
  if (!text->empty() && is_letter(text->front()) && text->back() != ' ' && !is_reserved &&
      std::all_of(text->begin(), text->end(), is_unquoted))
    return *text;
  recording::Value list;  // JSON quotes are valid in YAML
  list.data = recording::Values{value};
  const std::string json = recording::to_text(list);
  return json.substr(1, json.size() - 2);
}

/// The name of an enumeration value or of bits, as a comment after the value.
std::string name_comment(const recording::Structure& type, std::size_t field,
                         const recording::Value& value) {
  const auto* number = std::get_if<std::uint64_t>(&value.data);
  const std::string name = number ? value_name(type.name, type.fields[field].name, *number) : "";
  return name.empty() ? "" : "  # " + name;
}

std::string list_of_structures(const recording::Values& values, int indent) {
  std::string yaml;
  for (const auto& value : values) {
    std::string item = to_yaml(*value.members(), indent + 2);
    item[static_cast<std::size_t>(indent)] = '-';
    yaml += item;
  }
  return yaml;
}

}  // namespace

std::string to_yaml(const recording::Members& message, int indent) {
  std::string yaml;
  for (std::size_t i = 0; i < message.fields.size(); ++i) {
    const auto& value = message.fields[i];
    yaml += std::string(static_cast<std::size_t>(indent), ' ') + message.type->fields[i].name + ":";
    if (const auto* members = value.members()) yaml += "\n" + to_yaml(*members, indent + 2);
    else if (const auto* values = value.elements(); values && holds_structures(*values))
      yaml += "\n" + list_of_structures(*values, indent + 2);
    else yaml += " " + scalar(value) + name_comment(*message.type, i, value) + "\n";
  }
  return yaml;
}

}  // namespace launch
