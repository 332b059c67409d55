#include "launch/erp/new/new_controller.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <stdexcept>
#include <string_view>

namespace launch {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t max_name_length = 32;  // the field `component` of messages is a string<32>
constexpr auto reserved_names = std::to_array<std::string_view>(
    {"sim", "plant", "gateway", "replay", "logger", "reference", "target", "length_control",
     "force_control", "gap_monitor", "controller", "erp", "node", "main", "test"});
constexpr auto keywords = std::to_array<std::string_view>(
    {"auto",      "bool",    "break",    "case",    "catch",     "char",   "class",    "const",
     "continue",  "default", "delete",   "do",      "double",    "else",   "enum",     "explicit",
     "export",    "extern",  "false",    "float",   "for",       "friend", "goto",     "if",
     "inline",    "int",     "long",     "mutable", "namespace", "new",    "operator", "private",
     "protected", "public",  "register", "return",  "short",     "signed", "sizeof",   "static",
     "struct",    "switch",  "template", "this",    "throw",     "true",   "try",      "typedef",
     "typename",  "union",   "unsigned", "using",   "virtual",   "void",   "volatile", "while"});

bool is_snake_case(const std::string& name) {
  const auto is_allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !name.empty() && name.front() >= 'a' && name.front() <= 'z' && name.back() != '_' &&
         name.find("__") == name.npos && std::all_of(name.begin(), name.end(), is_allowed);
}

void check_name(const std::string& name) {
  const auto reject = [&name](const std::string& reason) {
    throw std::invalid_argument("\"" + name + "\" cannot be the name of a controller: " + reason);
  };
  if (!is_snake_case(name)) reject("use lower-case words joined by _, such as my_controller");
  if (name.size() > max_name_length) reject("it has more than 32 characters");
  if (std::find(keywords.begin(), keywords.end(), name) != keywords.end())
    reject("it is a keyword of C++");
  if (std::find(reserved_names.begin(), reserved_names.end(), name) != reserved_names.end())
    reject("a program of this name exists already");
}

std::string with_names(std::string text, const std::string& name) {
  for (const auto& [placeholder, value] :
       {std::pair<std::string, std::string>{"@name@", name}, {"@Class@", class_name(name)}})
    for (auto position = text.find(placeholder); position != text.npos;
         position = text.find(placeholder, position + value.size()))
      text.replace(position, placeholder.size(), value);
  return text;
}

/// `controller.hpp` → `<name>.hpp`, `controller_test.cpp` → `<name>_test.cpp`.
std::string file_name(const std::string& file, const std::string& name) {
  constexpr std::string_view stem = "controller";
  return file.starts_with(stem) ? name + file.substr(stem.size()) : file;
}

void write(const fs::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path.string() + ": cannot be written");
}

}  // namespace

std::string class_name(const std::string& snake_case_name) {
  std::string result;
  bool is_word_start = true;
  for (const char c : snake_case_name) {
    if (c != '_')
      result += is_word_start ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    is_word_start = c == '_';
  }
  return result;
}

std::vector<fs::path> new_controller(const std::string& name, const fs::path& folder) {
  check_name(name);
  if (fs::exists(folder) && !(fs::is_directory(folder) && fs::is_empty(folder)))
    throw std::invalid_argument(folder.string() + " exists already; name a new folder");
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error(folder.string() + ": " + error.message());
  std::vector<fs::path> files;
  for (const auto& [file, text] : controller_templates()) {
    files.push_back(folder / file_name(file, name));
    write(files.back(), with_names(text, name));
  }
  return files;
}

}  // namespace launch
