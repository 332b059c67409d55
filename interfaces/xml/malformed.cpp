#include <algorithm>
#include <cctype>

#include "interfaces/xml/document.hpp"
#include "interfaces/xml/words.hpp"

namespace xml {
namespace {

constexpr auto npos = std::string_view::npos;

struct Fault {
  std::size_t offset;
  std::string what, remedy;
};

/// One pass over a text with a stack of open elements; throws the first Fault.
class Scan {
 public:
  explicit Scan(std::string_view text) : text_(text) {}

  void run() {
    characters();
    while (at_ < text_.size()) rest().front() == '<' ? markup() : plain_text();
    if (!open_.empty())
      throw Fault{open_.back().offset, "<" + name_of(open_.back()) + "> is never closed",
                  "add </" + name_of(open_.back()) + ">"};
  }

 private:
  struct Name {
    std::size_t offset;  ///< of the `<`
    std::string_view text;
  };

  std::string_view rest() const { return text_.substr(at_); }
  static std::string name_of(const Name& name) { return std::string(name.text); }
  static bool in_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) ||
           std::string_view("_:-.").find(c) != npos || static_cast<unsigned char>(c) >= 0x80;
  }

  void characters() const;
  void entities(std::size_t begin, std::string_view text) const;
  void plain_text();
  void markup();
  void comment();
  void closing_tag();
  void opening_tag();
  void attribute(const std::string& element, std::vector<std::string_view>& seen);
  std::string_view name(const char* of_what);
  bool skip_blanks();

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<Name> open_;
  bool root_seen_ = false;
};

/// Length in bytes of a UTF-8 character with this first byte; 0: not a valid first byte.
std::size_t utf8_length(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first < 0xE0) return 2;
  if (first >= 0xE0 && first < 0xF0) return 3;
  return first >= 0xF0 && first < 0xF5 ? 4 : 0;
}

void Scan::characters() const {
  for (std::size_t i = 0, length; i < text_.size(); i += length) {
    const auto c = static_cast<unsigned char>(text_[i]);
    length = utf8_length(c);
    const std::string_view tail = text_.substr(i + 1, length - (length > 0));
    const bool whole = length > 0 && tail.size() == length - 1 &&
                       std::all_of(tail.begin(), tail.end(), [](char t) {
                         return (static_cast<unsigned char>(t) & 0xC0u) == 0x80u;
                       });
    if (!whole) throw Fault{i, "is not UTF-8 text", "save the file as UTF-8"};
    if (c < 0x20 && c != '\t' && c != '\n' && c != '\r')
      throw Fault{i, "has a control character, code " + std::to_string(c), "remove it"};
  }
}

void Scan::entities(std::size_t begin, std::string_view text) const {
  for (std::size_t i = text.find('&'); i != npos; i = text.find('&', i + 1)) {
    const std::string_view entity = text.substr(i + 1, text.substr(i + 1).find(';'));
    const bool known = entity == "amp" || entity == "lt" || entity == "gt" || entity == "quot" ||
                       entity == "apos" || (entity.size() > 1 && entity.front() == '#');
    if (!known || text.find(';', i) == npos) throw Fault{begin + i, "a bare \"&\"", "write &amp;"};
  }
}

void Scan::plain_text() {
  const std::size_t end = std::min(text_.find('<', at_), text_.size());
  const std::string_view words = text_.substr(at_, end - at_);
  const std::size_t first = words.find_first_not_of(" \t\r\n");
  if (open_.empty() && first != npos)
    throw Fault{at_ + first, "text outside the root element: " + quote(trimmed(words)),
                "remove it, or put it into a comment"};
  entities(at_, words);
  at_ = end;
}

void Scan::markup() {
  if (rest().starts_with("<!--")) return comment();
  if (rest().starts_with("</")) return closing_tag();
  if (rest().starts_with("<?xml") && !root_seen_) {
    const std::size_t end = rest().find("?>");
    if (end == npos) throw Fault{at_, "the declaration <?xml is never closed", "end it with ?>"};
    at_ += end + 2;
    return;
  }
  if (rest().starts_with("<!") || rest().starts_with("<?"))
    throw Fault{at_, "document types, CDATA and instructions are not used in these files",
                "write plain elements"};
  opening_tag();
}

void Scan::comment() {
  const std::size_t begin = at_ + std::string_view("<!--").size();
  const std::size_t dashes = text_.find("--", begin);
  if (dashes == npos) throw Fault{at_, "a comment is never closed", "end it with -->"};
  if (!text_.substr(dashes).starts_with("-->"))
    throw Fault{dashes, "\"--\" inside a comment", "XML does not allow it: write one dash"};
  at_ = dashes + 3;
}

std::string_view Scan::name(const char* of_what) {
  const std::size_t begin = at_;
  while (at_ < text_.size() && in_name(text_[at_])) ++at_;
  const std::string_view found = text_.substr(begin, at_ - begin);
  if (found.empty() || std::string_view("-.0123456789").find(found.front()) != npos)
    throw Fault{begin, std::string("expected the name of an ") + of_what,
                "names begin with a letter; a \"<\" in a text is written &lt;"};
  return found;
}

bool Scan::skip_blanks() {
  const std::size_t begin = at_;
  at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size());
  return at_ > begin;
}

void Scan::closing_tag() {
  const std::size_t begin = at_;
  at_ += 2;
  const std::string closes(name("element"));
  skip_blanks();
  if (!rest().starts_with(">")) throw Fault{begin, "</" + closes + " has no \">\"", "add it"};
  ++at_;
  if (open_.empty())
    throw Fault{begin, "</" + closes + "> has no opening tag",
                "remove it, or add <" + closes + ">"};
  if (closes != open_.back().text)
    throw Fault{begin, "</" + closes + "> where <" + name_of(open_.back()) + "> is open",
                "write </" + name_of(open_.back()) + "> first"};
  open_.pop_back();
}

void Scan::opening_tag() {
  const std::size_t begin = at_++;
  const std::string_view element = name("element");
  if (open_.empty() && root_seen_)
    throw Fault{begin, "a second root element <" + std::string(element) + ">",
                "a file has one root: move this element inside, or into its own file"};
  root_seen_ = true;
  std::vector<std::string_view> seen;
  for (;;) {
    const bool apart = skip_blanks();
    if (at_ >= text_.size() || rest().front() == '<')
      throw Fault{begin, "<" + std::string(element) + " has no \">\"", "end it with > or />"};
    if (rest().starts_with("/>")) return void(at_ += 2);
    if (rest().front() == '>') break;
    if (!apart) throw Fault{at_, "no space between two attributes", "add one"};
    attribute(std::string(element), seen);
  }
  ++at_;
  open_.push_back({begin, element});
}

void Scan::attribute(const std::string& element, std::vector<std::string_view>& seen) {
  const std::size_t begin = at_;
  const std::string_view key = name("attribute");
  const std::string title = "<" + element + ">: " + std::string(key);
  if (std::find(seen.begin(), seen.end(), key) != seen.end())
    throw Fault{begin, title + " is given twice", "keep one"};
  seen.push_back(key);
  skip_blanks();
  if (!rest().starts_with("=")) throw Fault{begin, title + " has no value", "write name=\"value\""};
  ++at_;
  skip_blanks();
  const char quote = at_ < text_.size() ? text_[at_] : ' ';
  if (quote != '"' && quote != '\'')
    throw Fault{begin, title + " has a value without quotes", "write name=\"value\""};
  const std::size_t end = text_.find(quote, at_ + 1);
  const std::string_view value = text_.substr(at_ + 1, end == npos ? npos : end - at_ - 1);
  if (end == npos || value.find('<') != npos)
    throw Fault{begin, title + " has no closing quote, or a \"<\" in its value",
                "close the quote; a \"<\" is written &lt;"};
  entities(at_ + 1, value);
  at_ = end + 1;
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
  } catch (const Fault& fault) {
    return {{place_at(text, fault.offset, file), fault.what, fault.remedy}};
  }
  return {};
}

}  // namespace xml
