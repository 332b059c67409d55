#include "interfaces/xml/units.hpp"

#include <map>
#include <sstream>
#include <vector>

namespace xml {
namespace {

/// Units as written in names, and as printed.
const std::map<std::string, std::string> units{
    {"A", "A"},    {"A2", "A²"},   {"Hz", "Hz"},         {"K", "K"},     {"N", "N"},
    {"Nm", "N m"}, {"V", "V"},     {"Vs", "V s"},        {"W", "W"},     {"H", "H"},
    {"kg", "kg"},  {"m", "m"},     {"m2", "m²"},         {"m3", "m³"},   {"ohm", "ohm"},
    {"px", "px"},  {"rad", "rad"}, {"rev", "rev"},       {"s", "s"},     {"s2", "s²"},
    {"s3", "s³"},  {"ns", "ns"},   {"counts", "counts"}, {"kelvin", "K"}};

std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words;
  std::istringstream stream(name);
  for (std::string word; std::getline(stream, word, '_');) words.push_back(word);
  return words;
}

}  // namespace

std::string unit_of(const std::string& name) {
  const auto words = words_of(name);
  std::size_t first = words.size();
  bool is_quotient = false;
  while (first > 0 && (words[first - 1] == "per" || units.contains(words[first - 1])))
    is_quotient |= words[--first] == "per";
  if (first == 0 && !is_quotient) ++first;  // the name itself: "counts"
  std::string unit;
  for (std::size_t i = first; i < words.size(); ++i) {
    if (words[i] == "per") unit += unit.empty() ? "1/" : "/";
    else unit += (unit.empty() || unit.back() == '/' ? "" : " ") + units.at(words[i]);
  }
  return unit;
}

}  // namespace xml
