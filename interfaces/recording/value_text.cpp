#include <array>
#include <charconv>
#include <cmath>

#include "interfaces/recording/cdr.hpp"

namespace recording {
namespace {

std::string quoted(const std::string& text) {
  static constexpr char hex[] = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') (out += '\\') += c;
    else if (code < 0x20) ((out += "\\u00") += hex[code >> 4]) += hex[code & 15];
    else out += c;
  }
  return out += '"';
}

template <class Number>
std::string shortest(Number value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}

struct Printer {
  bool json;
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(std::uint64_t value) const { return std::to_string(value); }
  std::string operator()(float value) const { return real(value); }
  std::string operator()(double value) const { return real(value); }
  std::string operator()(const std::string& value) const { return json ? quoted(value) : value; }
  std::string operator()(const Values& values) const {
    std::string out = "[";
    for (const Value& value : values) (out += out.size() > 1 ? "," : "") += inner(value);
    return out + "]";
  }
  std::string operator()(const Members& members) const {
    std::string out = "{";
    for (std::size_t i = 0; i < members.fields.size(); ++i)
      (out += i ? "," : "") +=
          quoted(members.type->fields[i].name) + ":" + inner(members.fields[i]);
    return out + "}";
  }

 private:
  static std::string inner(const Value& value) { return std::visit(Printer{true}, value.data); }
  template <class Real>
  std::string real(Real value) const {
    if (json && !std::isfinite(value)) return "null";  // JSON has no other representation
    return shortest(value);
  }
};

}  // namespace

std::string to_text(const Value& value) { return std::visit(Printer{false}, value.data); }
std::string to_json(const Members& members) { return Printer{true}(members); }

}  // namespace recording
