#include "interfaces/xml/writer.hpp"

namespace xml {
namespace {

constexpr std::size_t columns = 100;

/// `<name a="…" b="…"`, wrapped.
std::string opening(const std::string& name, const std::vector<WrittenAttribute>& attributes,
                    const std::string& indent) {
  const std::string continued = "\n" + indent + std::string(name.size() + 1, ' ');
  std::string text = indent + "<" + name;
  std::size_t width = text.size();
  for (const auto& [key, value] : attributes) {
    const std::string attribute = " " + key + "=\"" + escaped(value) + "\"";
    if (width + attribute.size() > columns - 2) text += continued, width = continued.size() - 1;
    text += attribute;
    width += attribute.size();
  }
  return text;
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\n':
        safe += "&#10;";
        break;
      case '\r':
        safe += "&#13;";
        break;
      case '\t':
        safe += "&#9;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string file_text(const std::string& element) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + element;
}

std::string element_text(const std::string& name, const std::vector<WrittenAttribute>& attributes,
                         const std::string& children, std::size_t depth) {
  const std::string indent(2 * depth, ' '), text = opening(name, attributes, indent);
  if (children.empty()) return text + "/>\n";
  return text + ">\n" + children + indent + "</" + name + ">\n";
}

std::string text_element(const std::string& name, const std::vector<WrittenAttribute>& attributes,
                         const std::string& words, std::size_t depth) {
  return opening(name, attributes, std::string(2 * depth, ' ')) + ">" + escaped(words) + "</" +
         name + ">\n";
}

}  // namespace xml
