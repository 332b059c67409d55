#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "interfaces/xml/errors.hpp"

/// An XML text as a tree of plain structs. Elements and attributes contain their place in the file.
namespace xml {

struct Element {
  Place place;  ///< of the `<`
  std::string name;
  std::vector<Attribute> attributes;
  std::vector<Element> children;
  std::vector<std::pair<Place, std::string>> stray_text;  ///< text between the children
};

/// The root element of a text. Throws Errors with one error when the text is not well-formed XML.
/// `file`: file name in error messages.
Element parse_document(std::string_view text, const std::string& file);

/// The largest file that `read_document` reads; chosen.
inline constexpr std::uint64_t max_document_bytes = std::uint64_t{64} << 20;

/// The content of a regular file. Throws Errors when it is missing, unreadable, larger, or a pipe, a
/// device or a folder.
std::string text_of_file(const std::string& file, std::uint64_t max_bytes = max_document_bytes);

/// The root element of a file. Throws Errors also when it is missing, unreadable or empty.
Element read_document(const std::string& file);

/// One error if the root element has another name; otherwise empty.
std::vector<Error> wrong_root(const Element& root, const std::string& expected);

/// Resolves a file name relative to the folder of `from_file`, the file that contains it.
std::string resolved(const std::string& file, const std::string& from_file);

/// The first violation of XML 1.0 in a text, with its place; empty if there is none. Covers
/// elements, attributes, entities and comments. tinyxml2 accepts some violations and reports no
/// columns.
std::vector<Error> malformed(std::string_view text, const std::string& file);

/// Line and column (both from 1, columns in characters) of a byte in a text.
Place place_at(std::string_view text, std::size_t offset, const std::string& file);

}  // namespace xml
