#include "interfaces/xml/schema.hpp"

#include <algorithm>
#include <stdexcept>

namespace xml {
namespace {

using Child = SchemaParts::Child;

/// `<xs:annotation>` with the description; empty without one.
std::string annotation(const std::string& description) {
  if (description.empty()) return "";
  std::string text;
  for (const char c : description)
    text += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return "<xs:annotation><xs:documentation>" + text + "</xs:documentation></xs:annotation>";
}

std::string attribute_text(const SchemaParts::Attribute& attribute) {
  return "<xs:attribute name=\"" + attribute.name + "\"" +
         (attribute.required ? " use=\"required\">" : ">") + annotation(attribute.description) +
         attribute.type + "</xs:attribute>";
}

std::string child_text(const Child& child) {
  return "<xs:element name=\"" + child.name + "\"" +
         (child.count == Child::optional ? " minOccurs=\"0\">" : ">") +
         annotation(child.description) + child.type + "</xs:element>";
}

/// The base types. They restrict numbers to the notation of the reader, without infinities.
const char* const base_types = R"(<xs:simpleType name="number">
<xs:restriction base="xs:double">
<xs:pattern value="[+\-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+\-]?[0-9]+)?"/>
<xs:minInclusive value="-1.7976931348623157e308"/>
<xs:maxInclusive value="1.7976931348623157e308"/>
</xs:restriction>
</xs:simpleType>
<xs:simpleType name="integer">
<xs:restriction base="xs:integer"/>
</xs:simpleType>
<xs:simpleType name="flag">
<xs:restriction base="xs:boolean">
<xs:pattern value="true|false"/>
</xs:restriction>
</xs:simpleType>
<xs:simpleType name="filled_text">
<xs:restriction base="xs:string">
<xs:pattern value="[\s\S]*\S[\s\S]*"/>
</xs:restriction>
</xs:simpleType>
)";

std::string one_tag_per_line(const std::string& text) {
  std::string lines;
  for (std::size_t i = 0; i < text.size(); ++i) {
    lines += text[i];
    if (text[i] == '>' && i + 1 < text.size() && text[i + 1] == '<') lines += '\n';
  }
  return lines;
}

std::string indented(const std::string& lines) {
  std::string text;
  std::size_t depth = 0;
  for (std::size_t begin = 0; begin < lines.size();) {
    const std::size_t end = lines.find('\n', begin);
    const std::string line = lines.substr(begin, end - begin);
    const bool closes = line.starts_with("</");
    const bool is_closed = !closes && line.find("</") != line.npos;
    const bool opens = !closes && !is_closed && !line.ends_with("/>") && !line.starts_with("<?") &&
                       !line.starts_with("<!");
    if (closes) --depth;
    text += std::string(2 * depth, ' ') + line + "\n";
    if (opens) ++depth;
    begin = end == lines.npos ? end : end + 1;
  }
  return text;
}

}  // namespace

std::string complex_type(const SchemaParts& parts) {
  const auto is_list = [](const Child& c) { return c.count == Child::any_number; };
  const bool has_lists = std::any_of(parts.children.begin(), parts.children.end(), is_list);
  if (has_lists && !std::all_of(parts.children.begin(), parts.children.end(), is_list))
    throw std::logic_error(
        "an element has both lists and single children; XSD 1.0 cannot express this");
  std::string text;
  for (const Child& child : parts.children) text += child_text(child);
  if (has_lists)
    text = "<xs:choice minOccurs=\"0\" maxOccurs=\"unbounded\">" + text + "</xs:choice>";
  else if (!text.empty()) text = "<xs:all>" + text + "</xs:all>";
  for (const SchemaParts::Attribute& attribute : parts.attributes)
    text += attribute_text(attribute);
  if (parts.allows_others) text += "<xs:anyAttribute processContents=\"skip\"/>";
  return text.empty() ? "<xs:complexType/>" : "<xs:complexType>" + text + "</xs:complexType>";
}

std::string schema_document(const std::string& root_name, const std::string& root_type) {
  const std::string document =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<!-- Generated from the structs' visit functions; do not edit. -->\n"
      "<xs:schema xmlns:xs=\"http://www.w3.org/2001/XMLSchema\">\n" +
      std::string(base_types) + "<xs:element name=\"" + root_name + "\">" + root_type +
      "</xs:element>\n</xs:schema>";
  return indented(one_tag_per_line(document));
}

}  // namespace xml
