#include "interfaces/xml/errors.hpp"

#include <algorithm>
#include <tuple>

namespace xml {
namespace {

std::vector<Error> by_place(std::vector<Error> errors) {
  const auto key = [](const Error& e) {
    return std::tie(e.place.file, e.place.line, e.place.column);
  };
  std::stable_sort(errors.begin(), errors.end(),
                   [&](const Error& a, const Error& b) { return key(a) < key(b); });
  return errors;
}

std::string lines(const std::vector<Error>& errors) {
  std::string text;
  for (const Error& error : errors) text += (text.empty() ? "" : "\n") + to_string(error);
  return text;
}

}  // namespace

std::string to_string(const Error& error) {
  std::string text = error.place.file;
  if (error.place.line > 0)
    text += ":" + std::to_string(error.place.line) + ":" + std::to_string(error.place.column);
  text += ": " + error.what;
  if (!error.remedy.empty()) text += "; " + error.remedy;
  return text;
}

Error error_in(const std::string& element, const Place& place, const std::string& message,
               const std::string& remedy) {
  return {place, "<" + element + ">: " + message, remedy};
}

Errors::Errors(std::vector<Error> errors)
    : std::runtime_error(lines(by_place(errors))), errors_(by_place(std::move(errors))) {}

void throw_if_any(std::vector<Error> errors) {
  if (!errors.empty()) throw Errors(std::move(errors));
}

}  // namespace xml
