#include "interfaces/xml/values.hpp"

#include <charconv>
#include <cmath>

namespace xml {
namespace {

ValueError out_of_range(const char* kind, const Range& range) {
  return {"is out of range", std::string("give ") + kind + range_words(range)};
}

/// std::from_chars does not accept a leading plus sign.
std::string_view without_plus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

/// The fewest digits that read back bit-equal. Values of moderate size have no exponent, because
/// XSD integers allow none.
template <class Float>
std::string shortest(Float value) {
  const Float size = std::abs(value);
  const bool is_moderate = size == 0 || (size >= Float(1e-4) && size < Float(1e20));
  char text[40];  // longer than any number in these formats
  const auto format = is_moderate ? std::chars_format::fixed : std::chars_format::scientific;
  return {text, std::to_chars(text, text + sizeof text, value, format).ptr};
}

}  // namespace

std::string range_words(const Range& range) {
  const bool has_min = std::isfinite(range.min), has_max = std::isfinite(range.max);
  if (has_min && has_max && !range.open_min && !range.open_max)
    return " from " + write_number(range.min) + " to " + write_number(range.max);
  std::string words;
  if (has_min) words += (range.open_min ? " > " : " >= ") + write_number(range.min);
  if (has_min && has_max) words += " and";
  if (has_max) words += (range.open_max ? " < " : " <= ") + write_number(range.max);
  return words;
}

std::optional<ValueError> read_number(std::string_view text, double& value, const Range& range) {
  text = without_plus(trimmed(text));
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault == std::errc::result_out_of_range)
    return ValueError{"does not fit a double", "give a number" + range_words(range)};
  if (fault != std::errc{} || end != text.data() + text.size())
    return ValueError{"is not a number", "give a number" + range_words(range)};
  if (!std::isfinite(value))
    return ValueError{"is not a finite number", "give a number" + range_words(range)};
  if (!range.contains(value)) return out_of_range("a number", range);
  return {};
}

std::optional<ValueError> read_integer(std::string_view text, long long& value, Range range) {
  text = without_plus(trimmed(text));
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault == std::errc::result_out_of_range) return out_of_range("an integer", range);
  if (fault != std::errc{} || end != text.data() + text.size())
    return ValueError{"is not an integer", "give an integer" + range_words(range)};
  if (!range.contains(static_cast<double>(value))) return out_of_range("an integer", range);
  return {};
}

std::optional<ValueError> read_flag(std::string_view text, bool& value) {
  text = trimmed(text);
  if (text != "true" && text != "false")
    return ValueError{"is neither true nor false", "write true or false"};
  value = text == "true";
  return {};
}

std::string write_number(double value) { return shortest(value); }
std::string write_number(float value) { return shortest(value); }

std::string xsd_restriction(const std::string& base, const Range& range) {
  std::string facets;
  const auto facet = [&](const char* name, double value) {
    facets += std::string("<xs:") + name + " value=\"" + write_number(value) + "\"/>";
  };
  if (std::isfinite(range.min)) facet(range.open_min ? "minExclusive" : "minInclusive", range.min);
  if (std::isfinite(range.max)) facet(range.open_max ? "maxExclusive" : "maxInclusive", range.max);
  return "<xs:simpleType><xs:restriction base=\"" + base + "\">" + facets +
         "</xs:restriction></xs:simpleType>";
}

std::string xsd_filled_text() { return xsd_restriction("filled_text", any); }

std::string xsd_list(const std::string& item_type, std::size_t length) {
  std::string list = "<xs:simpleType><xs:list>" + item_type + "</xs:list></xs:simpleType>";
  if (length == 0) return list;
  return "<xs:simpleType><xs:restriction>" + list + "<xs:length value=\"" + std::to_string(length) +
         "\"/></xs:restriction></xs:simpleType>";
}

std::string xsd_words(const std::vector<std::string>& words) {
  std::string facets;
  for (const std::string& word : words) facets += "<xs:enumeration value=\"" + word + "\"/>";
  return "<xs:simpleType><xs:restriction base=\"xs:string\">" + facets +
         "</xs:restriction></xs:simpleType>";
}

}  // namespace xml
