#include <algorithm>
#include <cctype>

#include "interfaces/xml/document.hpp"
#include "interfaces/xml/words.hpp"

namespace xml {
namespace {

constexpr auto npos = std::string_view::npos;

struct Violation {
  std::size_t offset;
  std::string what, remedy;
};

/// One pass over a text with a stack of open elements; throws the first Violation.
class Scan {
 public:
  explicit Scan(std::string_view text) : text_(text) {}

  void run() {
    check_characters();
    while (position_ < text_.size()) rest().front() == '<' ? scan_markup() : scan_text();
    if (!open_elements_.empty())
      throw Violation{open_elements_.back().offset,
                      "<" + name_of(open_elements_.back()) + "> is never closed",
                      "add </" + name_of(open_elements_.back()) + ">"};
  }

 private:
  struct Name {
    std::size_t offset;  ///< of the `<`
    std::string_view text;
  };

  std::string_view rest() const { return text_.substr(position_); }
  static std::string name_of(const Name& name) { return std::string(name.text); }
  static bool in_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) ||
           std::string_view("_:-.").find(c) != npos || static_cast<unsigned char>(c) >= 0x80;
  }

  void check_characters() const;
  void check_entities(std::size_t begin, std::string_view text) const;
  void scan_text();
  void scan_markup();
  void scan_comment();
  void scan_closing_tag();
  void scan_opening_tag();
  void scan_attribute(const std::string& element, std::vector<std::string_view>& attribute_names);
  std::string_view scan_name(const char* kind);
  bool skip_blanks();

  std::string_view text_;
  std::size_t position_ = 0;
  std::vector<Name> open_elements_;
  bool has_root_ = false;
};

/// Length in bytes of a UTF-8 character with this first byte; 0: not a valid first byte.
std::size_t utf8_length(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first < 0xE0) return 2;
  if (first >= 0xE0 && first < 0xF0) return 3;
  return first >= 0xF0 && first < 0xF5 ? 4 : 0;
}

void Scan::check_characters() const {
  for (std::size_t i = 0, length; i < text_.size(); i += length) {
    const auto c = static_cast<unsigned char>(text_[i]);
    length = utf8_length(c);
    const std::string_view tail = text_.substr(i + 1, length - (length > 0));
    const bool is_valid = length > 0 && tail.size() == length - 1 &&
                          std::all_of(tail.begin(), tail.end(), [](char t) {
                            return (static_cast<unsigned char>(t) & 0xC0u) == 0x80u;
                          });
    if (!is_valid) throw Violation{i, "is not UTF-8 text", "save the file as UTF-8"};
    if (c < 0x20 && c != '\t' && c != '\n' && c != '\r')
      throw Violation{i, "has a control character, code " + std::to_string(c), "remove it"};
  }
}

void Scan::check_entities(std::size_t begin, std::string_view text) const {
  for (std::size_t i = text.find('&'); i != npos; i = text.find('&', i + 1)) {
    const std::string_view entity = text.substr(i + 1, text.substr(i + 1).find(';'));
    const bool is_valid = entity == "amp" || entity == "lt" || entity == "gt" || entity == "quot" ||
                          entity == "apos" || (entity.size() > 1 && entity.front() == '#');
    if (!is_valid || text.find(';', i) == npos)
      throw Violation{begin + i, "a bare \"&\"", "write &amp;"};
  }
}

void Scan::scan_text() {
  const std::size_t end = std::min(text_.find('<', position_), text_.size());
  const std::string_view words = text_.substr(position_, end - position_);
  const std::size_t first = words.find_first_not_of(" \t\r\n");
  if (open_elements_.empty() && first != npos)
    throw Violation{position_ + first, "text outside the root element: " + quote(trimmed(words)),
                    "remove it, or put it into a comment"};
  check_entities(position_, words);
  position_ = end;
}

void Scan::scan_markup() {
  if (rest().starts_with("<!--")) return scan_comment();
  if (rest().starts_with("</")) return scan_closing_tag();
  if (rest().starts_with("<?xml") && !has_root_) {
    const std::size_t end = rest().find("?>");
    if (end == npos)
      throw Violation{position_, "the declaration <?xml is never closed", "end it with ?>"};
    position_ += end + 2;
    return;
  }
  if (rest().starts_with("<!") || rest().starts_with("<?"))
    throw Violation{position_, "document types, CDATA and instructions are not used in these files",
                    "write plain elements"};
  scan_opening_tag();
}

void Scan::scan_comment() {
  const std::size_t begin = position_ + std::string_view("<!--").size();
  const std::size_t dashes = text_.find("--", begin);
  if (dashes == npos) throw Violation{position_, "a comment is never closed", "end it with -->"};
  if (!text_.substr(dashes).starts_with("-->"))
    throw Violation{dashes, "\"--\" inside a comment", "XML does not allow it: write one dash"};
  position_ = dashes + 3;
}

std::string_view Scan::scan_name(const char* kind) {
  const std::size_t begin = position_;
  while (position_ < text_.size() && in_name(text_[position_])) ++position_;
  const std::string_view scanned = text_.substr(begin, position_ - begin);
  if (scanned.empty() || std::string_view("-.0123456789").find(scanned.front()) != npos)
    throw Violation{begin, std::string("expected the name of an ") + kind,
                    "names begin with a letter; a \"<\" in a text is written &lt;"};
  return scanned;
}

bool Scan::skip_blanks() {
  const std::size_t begin = position_;
  position_ = std::min(text_.find_first_not_of(" \t\r\n", position_), text_.size());
  return position_ > begin;
}

void Scan::scan_closing_tag() {
  const std::size_t begin = position_;
  position_ += 2;
  const std::string tag(scan_name("element"));
  skip_blanks();
  if (!rest().starts_with(">")) throw Violation{begin, "</" + tag + " has no \">\"", "add it"};
  ++position_;
  if (open_elements_.empty())
    throw Violation{begin, "</" + tag + "> has no opening tag", "remove it, or add <" + tag + ">"};
  if (tag != open_elements_.back().text)
    throw Violation{begin, "</" + tag + "> where <" + name_of(open_elements_.back()) + "> is open",
                    "write </" + name_of(open_elements_.back()) + "> first"};
  open_elements_.pop_back();
}

void Scan::scan_opening_tag() {
  const std::size_t begin = position_++;
  const std::string_view element = scan_name("element");
  if (open_elements_.empty() && has_root_)
    throw Violation{begin, "a second root element <" + std::string(element) + ">",
                    "a file has one root: move this element inside, or into its own file"};
  has_root_ = true;
  std::vector<std::string_view> attribute_names;
  for (;;) {
    const bool has_space = skip_blanks();
    if (position_ >= text_.size() || rest().front() == '<')
      throw Violation{begin, "<" + std::string(element) + " has no \">\"", "end it with > or />"};
    if (rest().starts_with("/>")) return void(position_ += 2);
    if (rest().front() == '>') break;
    if (!has_space) throw Violation{position_, "no space between two attributes", "add one"};
    scan_attribute(std::string(element), attribute_names);
  }
  ++position_;
  open_elements_.push_back({begin, element});
}

void Scan::scan_attribute(const std::string& element,
                          std::vector<std::string_view>& attribute_names) {
  const std::size_t begin = position_;
  const std::string_view key = scan_name("attribute");
  const std::string title = "<" + element + ">: " + std::string(key);
  if (std::find(attribute_names.begin(), attribute_names.end(), key) != attribute_names.end())
    throw Violation{begin, title + " is given twice", "keep one"};
  attribute_names.push_back(key);
  skip_blanks();
  if (!rest().starts_with("="))
    throw Violation{begin, title + " has no value", "write name=\"value\""};
  ++position_;
  skip_blanks();
  const char quote = position_ < text_.size() ? text_[position_] : ' ';
  if (quote != '"' && quote != '\'')
    throw Violation{begin, title + " has a value without quotes", "write name=\"value\""};
  const std::size_t end = text_.find(quote, position_ + 1);
  const std::string_view value =
      text_.substr(position_ + 1, end == npos ? npos : end - position_ - 1);
  if (end == npos || value.find('<') != npos)
    throw Violation{begin, title + " has no closing quote, or a \"<\" in its value",
                    "close the quote; a \"<\" is written &lt;"};
  check_entities(position_ + 1, value);
  position_ = end + 1;
}

}  // namespace

Place place_at(std::string_view text, std::size_t offset, const std::string& file) {
  const std::string_view before = text.substr(0, offset);
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const std::string_view in_line = before.substr(before.rfind('\n') + 1);
  const auto characters = std::count_if(in_line.begin(), in_line.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u;  // not a UTF-8 continuation byte
  });
  return {file, static_cast<int>(line), static_cast<int>(characters) + 1};
}

std::vector<Error> malformed(std::string_view text, const std::string& file) {
  try {
    Scan(text).run();
  } catch (const Violation& violation) {
    return {{place_at(text, violation.offset, file), violation.what, violation.remedy}};
  }
  return {};
}

}  // namespace xml
