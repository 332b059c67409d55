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

std::string to_table(const std::vector<Description>& all) {
  std::size_t names = 0, types = 0, units = 0, presences = 0;
  for (const Description& d : all) {
    names = std::max(names, d.name.size());
    types = std::max(types, d.type.size());
    units = std::max(units, unit(d).size());
    presences = std::max(presences, presence(d).size());
  }
  std::string table;
  for (const Description& d : all) {
    std::string line = padded(d.name, names) + "  " + padded(d.type, types) + "  " +
                       padded(unit(d), units) + "  " + padded(presence(d), presences) + "  " +
                       d.meaning;
    line.erase(line.find_last_not_of(' ') + 1);
    table += line + "\n";
  }
  return table;
}

}  // namespace xml
