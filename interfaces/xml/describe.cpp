#include "interfaces/xml/describe.hpp"

#include <algorithm>

namespace xml {
namespace {

std::string padded(std::string text, std::size_t width) {
  // × takes two bytes and one column
  for (std::size_t i = text.find("×"); i != text.npos; i = text.find("×", i + 2)) ++width;
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

std::string presence(const Description& d) {
  if (d.required) return "required";
  return d.default_text.empty() ? "" : "default " + d.default_text;
}

}  // namespace

std::string to_table(const std::vector<Description>& all) {
  std::size_t names = 0, types = 0, presences = 0;
  for (const Description& d : all) {
    names = std::max(names, d.name.size());
    types = std::max(types, d.type.size());
    presences = std::max(presences, presence(d).size());
  }
  std::string table;
  for (const Description& d : all) {
    std::string line = padded(d.name, names) + "  " + padded(d.type, types) + "  " +
                       padded(presence(d), presences) + "  " + d.meaning;
    line.erase(line.find_last_not_of(' ') + 1);
    table += line + "\n";
  }
  return table;
}

}  // namespace xml
