#include "interfaces/xml/describe.hpp"

#include <algorithm>

#include "interfaces/xml/units.hpp"

namespace xml {
namespace {

std::string padded(std::string text, std::size_t width) {
  // × and ² take two bytes and one column
  width += static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) == 0x80;
  }));
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

std::string presence(const Description& d) {
  if (d.required) return "required";
  return d.default_text.empty() ? "" : "default " + d.default_text;
}

std::string unit(const Description& d) { return d.is_element ? "" : unit_of(d.name); }

}  // namespace

std::string to_table(const std::vector<Description>& descriptions) {
  std::size_t name_width = 0, type_width = 0, unit_width = 0, presence_width = 0;
  for (const Description& d : descriptions) {
    name_width = std::max(name_width, d.name.size());
    type_width = std::max(type_width, d.type.size());
    unit_width = std::max(unit_width, unit(d).size());
    presence_width = std::max(presence_width, presence(d).size());
  }
  std::string table;
  for (const Description& d : descriptions) {
    std::string line = padded(d.name, name_width) + "  " + padded(d.type, type_width) + "  " +
                       padded(unit(d), unit_width) + "  " + padded(presence(d), presence_width) +
                       "  " + d.description;
    line.erase(line.find_last_not_of(' ') + 1);
    table += line + "\n";
  }
  return table;
}

}  // namespace xml
