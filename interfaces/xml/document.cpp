#include "interfaces/xml/document.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "interfaces/xml/words.hpp"

namespace xml {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

[[noreturn]] void throw_error(const Place& place, const std::string& what,
                              const std::string& remedy) {
  throw Errors({{place, what, remedy}});
}

/// tinyxml2 reports lines, but no columns. It parses in place: names and texts point into one
/// buffer, its copy of the text. A declaration before the text marks the beginning of that buffer:
/// a pointer then gives an offset in the original text, and the offset gives line and column.
class Tree {
 public:
  Tree(std::string_view text, const std::string& file) : text_(text), file_(file) {
    const std::string declared_text = std::string(declaration) + std::string(text);
    document_.Parse(declared_text.data(), declared_text.size());
    if (document_.Error())
      throw_error(place_of_line(document_.ErrorLineNum()), "XML is not well-formed",
                  document_.ErrorName());
    begin_ = document_.FirstChild()->Value() - std::strlen("<?") + declaration.size();
  }

  Element root() const {
    const tinyxml2::XMLElement* root = document_.RootElement();
    if (!root) throw_error({file_, 1, 1}, "contains no element", "write the root element");
    return element(*root);
  }

 private:
  static constexpr std::string_view declaration = "<?xml?>";

  std::size_t offset(const char* in_buffer) const {
    return static_cast<std::size_t>(in_buffer - begin_);
  }
  Place place(const char* in_buffer) const { return place_at(text_, offset(in_buffer), file_); }
  Place place_of_line(int line) const { return {file_, line, 1}; }

  Element element(const tinyxml2::XMLElement& from) const {
    Element to{place(from.Name() - 1), from.Name(), {}, {}, {}};
    for (auto* a = from.FirstAttribute(); a; a = a->Next())
      to.attributes.push_back({place(a->Name()), a->Name(), a->Value()});
    for (auto* child = from.FirstChild(); child; child = child->NextSibling()) {
      if (auto* inner = child->ToElement()) to.children.push_back(element(*inner));
      if (auto* words = child->ToText()) to.stray_text.push_back(text(*words));
    }
    return to;
  }

  std::pair<Place, std::string> text(const tinyxml2::XMLText& from) const {
    const std::size_t begin =
        offset(from.Value());  // Value() may shorten line ends after this position
    const std::size_t first = text_.find_first_not_of(" \t\r\n", begin);
    return {place_at(text_, first, file_), std::string(trimmed(from.Value()))};
  }

  tinyxml2::XMLDocument document_;
  std::string_view text_;
  const std::string& file_;
  const char* begin_ = nullptr;
};

}  // namespace

std::string text_of_file(const std::string& file, std::uint64_t max_bytes) {
  const Place whole_file{file, 0, 0};
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    throw_error(whole_file, "no such file", "check the path, or create the file");
  if (std::filesystem::is_directory(status))
    throw_error(whole_file, "is a folder", "give the XML file in it");
  // A pipe would wait for a writer; a device may have no end.
  if (!std::filesystem::is_regular_file(status))
    throw_error(whole_file, "is not a regular file", "give the name of a file");
  if (const auto size = std::filesystem::file_size(file, error); !error && size > max_bytes)
    throw_error(whole_file,
                "has " + std::to_string(size) + " bytes, at most " + std::to_string(max_bytes) +
                    " are read",
                "give the right file, or divide it");
  std::ifstream in(file, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (!in.eof() && in.fail())
    throw_error(whole_file, std::string("cannot be read: ") + std::strerror(errno),
                "check its permissions");
  return text;
}

Element parse_document(std::string_view text, const std::string& file) {
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  if (trimmed(text).empty()) throw_error({file, 1, 1}, "is empty", "write the root element");
  throw_if_any(malformed(text, file));
  return Tree(text, file).root();
}

std::vector<Error> wrong_root(const Element& root, const std::string& expected) {
  if (root.name == expected) return {};
  return {error_in(root.name, root.place, "the root element must be <" + expected + ">",
                   did_you_mean(root.name, {expected}))};
}

std::string resolved(const std::string& file, const std::string& from_file) {
  return (std::filesystem::path(from_file).parent_path() / file).lexically_normal().string();
}

Element read_document(const std::string& file) { return parse_document(text_of_file(file), file); }

}  // namespace xml
