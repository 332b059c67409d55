#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "interfaces/xml/fields.hpp"

namespace xml {

/// One error: place, what is wrong (with the value), remedy.
struct Error {
  Place place;
  std::string what, remedy;
};

/// `file:line:column: what; remedy`. Line 0 refers to the file as a whole.
std::string to_string(const Error& error);

/// An error about the element `<element>` at `place`.
Error error_in(const std::string& element, const Place& place, const std::string& message,
               const std::string& remedy);

/// All errors found in a file, in the order of their places; `what()` has one line per error.
class Errors : public std::runtime_error {
 public:
  explicit Errors(std::vector<Error> errors);
  const std::vector<Error>& all() const { return errors_; }

 private:
  std::vector<Error> errors_;
};

/// Throws Errors when there are any.
void throw_if_any(std::vector<Error> errors);

}  // namespace xml
