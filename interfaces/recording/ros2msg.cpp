#include "interfaces/recording/ros2msg.hpp"

#include <charconv>
#include <map>
#include <optional>

namespace recording {
namespace {

constexpr std::string_view blanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(blanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Removes and returns the text before the first `end`, or all of it; also removes that `end`.
std::string_view cut_front(std::string_view& text, char end) {
  const auto at = text.find(end);
  const std::string_view front = text.substr(0, at);
  text = at == text.npos ? std::string_view{} : text.substr(at + 1);
  return front;
}

bool is_word(std::string_view text) {
  constexpr auto* allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  return !text.empty() && text.find_first_not_of(allowed) == text.npos &&
         !(text[0] >= '0' && text[0] <= '9');
}

std::optional<Kind> primitive(std::string_view name) {
  if (name == "byte" || name == "char") return Kind::uint8;
  for (int k = 0; k < static_cast<int>(Kind::structure); ++k)
    if (name == name_of(static_cast<Kind>(k))) return static_cast<Kind>(k);
  return std::nullopt;
}

/// "package/Type" and "package/msg/Type" are the same name.
std::string full_name(std::string_view name) {
  const auto slash = name.rfind('/');
  if (slash == name.npos || name.find("/msg/") != name.npos) return std::string(name);
  return std::string(name.substr(0, slash)) + "/msg" + std::string(name.substr(slash));
}

class Parser {
 public:
  explicit Parser(std::string_view name) : schema_(name) { open(full_name(name)); }

  TypeDescription run(std::string_view text) {
    while (!text.empty()) {
      ++line_;
      take_line(cut_front(text, '\n'));
    }
    resolve();
    try {
      check(type_);
    } catch (const std::invalid_argument& error) {
      throw RecordingError(schema_ + ": " + error.what() + "; " + remedy);
    }
    return std::move(type_);
  }

 private:
  static constexpr const char* remedy = "the schema does not describe a readable message";
  struct Reference {
    std::size_t structure, field;
    std::string name;
    int line;
  };

  [[noreturn]] void fail(int line, const std::string& what) const {
    throw RecordingError("schema " + schema_ + ":" + std::to_string(line) + ": " + what + "; " +
                         remedy);
  }

  void open(const std::string& name) {
    structure_index_.try_emplace(name, type_.structures.size());
    type_.structures.push_back({name, {}});
  }

  void take_line(std::string_view line) {
    const bool separator = line.size() >= 3 && line.find_first_not_of("=\r") == line.npos;
    if (separator) {
      expects_name_ = true;
      return;
    }
    if (expects_name_) {
      if (trimmed(line).empty()) return;
      if (!line.starts_with("MSG:")) fail(line_, "expected \"MSG: package/Type\" after ===");
      open(full_name(trimmed(line.substr(4))));
      expects_name_ = false;
      return;
    }
    std::string_view rest = line;
    const std::string_view code = trimmed(cut_front(rest, '#'));
    if (!code.empty()) take_field(code, trimmed(rest));
  }

  void take_field(std::string_view code, std::string_view comment) {
    std::string_view rest = code;
    const auto gap = code.find_first_of(blanks);
    const std::string_view type = code.substr(0, gap);
    rest = gap == code.npos ? std::string_view{} : trimmed(code.substr(gap));
    const std::string_view name = rest.substr(0, rest.find_first_of(" \t="));
    const std::string_view remainder = trimmed(rest.substr(name.size()));
    if (remainder.starts_with('=')) return;  // a constant
    if (!is_word(name)) fail(line_, "\"" + std::string(code) + "\" is not \"type name\"");
    Field field;
    field.name = name;
    take_comment(comment, field);
    take_type(type, field);
    type_.structures.back().fields.push_back(std::move(field));
  }

  /// "tension_N [N]": the original name of the field `tension_n`, and its unit.
  static void take_comment(std::string_view comment, Field& field) {
    const std::string_view word = comment.substr(0, comment.find_first_of(blanks));
    const std::string_view rest = trimmed(comment.substr(word.size()));
    const bool has_name = is_word(word);
    const std::string_view unit = has_name ? rest : comment;
    if (unit.starts_with('[') && unit.ends_with(']') && unit.size() > 2)
      field.unit = unit.substr(1, unit.size() - 2);
    else if (!unit.empty()) return;  // an ordinary comment
    if (!has_name) return;
    const std::string ros_name = ros_field_name(word);
    const bool is_original_name =
        field.name.starts_with(ros_name) &&
        field.name.find_first_not_of("0123456789", ros_name.size()) == field.name.npos;
    if (is_original_name) field.name = word;
  }

  void take_type(std::string_view type, Field& field) {
    const auto bracket = type.find('[');
    if (bracket != type.npos) {
      if (!type.ends_with(']')) fail(line_, "\"" + std::string(type) + "\" lacks a ]");
      take_count(type.substr(bracket + 1, type.size() - bracket - 2), field);
      type = type.substr(0, bracket);
    }
    if (const auto bound = type.find("<="); bound != type.npos) {
      field.string_bound = number(type.substr(bound + 2));
      type = type.substr(0, bound);
      if (type != "string") fail(line_, "only a string has a bound");
    }
    if (const auto kind = primitive(type)) {
      field.kind = *kind;
      return;
    }
    field.kind = Kind::structure;
    const auto& structures = type_.structures;
    references_.push_back(
        {structures.size() - 1, structures.back().fields.size(), std::string(type), line_});
  }

  void take_count(std::string_view text, Field& field) {
    const bool bounded = text.starts_with("<=");
    field.count = text.empty() || bounded ? Count::sequence : Count::array;
    if (!text.empty()) field.size = number(text.substr(bounded ? 2 : 0));
  }

  std::uint32_t number(std::string_view text) const {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || value == 0)
      fail(line_, "\"" + std::string(text) + "\" is not a count");
    return value;
  }

  void resolve() {
    for (const Reference& reference : references_) {
      const std::string& owner = type_.structures[reference.structure].name;
      std::string name = reference.name;
      if (name.find('/') == name.npos) name = owner.substr(0, owner.rfind('/') + 1) + name;
      const auto index = structure_index_.find(full_name(name));
      if (index == structure_index_.end())
        fail(reference.line, "unknown type \"" + reference.name + "\"");
      type_.structures[reference.structure].fields[reference.field].structure = index->second;
    }
  }

  std::string schema_;
  TypeDescription type_;
  std::map<std::string, std::size_t> structure_index_;
  std::vector<Reference> references_;
  int line_ = 0;
  bool expects_name_ = false;
};

}  // namespace

TypeDescription parse_ros2msg(std::string_view name, std::string_view text) {
  return Parser(name).run(text);
}

}  // namespace recording
