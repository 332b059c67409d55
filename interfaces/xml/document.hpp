#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "interfaces/xml/errors.hpp"

/// An XML text as a tree of plain structs in which everything knows its place.
namespace xml {

struct Element {
  Place place;  ///< of the `<`
  std::string name;
  std::vector<Attribute> attributes;
  std::vector<Element> children;
  std::vector<std::pair<Place, std::string>> stray_text;  ///< text between the children
};

/// The root element of a text. Throws Errors (one) when the text is not well-formed XML.
/// `file` is only the name that errors carry.
Element parse_document(std::string_view text, const std::string& file);

/// The root element of a file. Throws Errors also when it is missing, unreadable or empty.
Element read_document(const std::string& file);

/// A file name as written in `from_file`: relative to that file's folder.
std::string resolved(const std::string& file, const std::string& from_file);

/// The first thing in a text that XML 1.0 does not allow, with its place; tinyxml2 forgives some
/// of it and gives lines only. Covers elements, attributes, entities and comments.
std::vector<Error> malformed(std::string_view text, const std::string& file);

/// Line and column (both from 1, columns in characters) of a byte in a text.
Place place_at(std::string_view text, std::size_t offset, const std::string& file);

}  // namespace xml
