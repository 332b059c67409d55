#pragma once
#include <optional>
#include <string>
#include <vector>

#include "interfaces/xml/document.hpp"

/// An XML element of another format. Unknown content is ignored. A required item that is missing or
/// not a number is an error with its position in the file. Throws xml::Errors.
namespace formats {

class Foreign {
 public:
  explicit Foreign(const xml::Element& element) : element_(&element) {}

  const xml::Element& element() const { return *element_; }
  std::vector<Foreign> children() const {
    return {element_->children.begin(), element_->children.end()};
  }
  const std::string& tag() const { return element_->name; }
  /// Children with this tag: all; the first one, if any; the first one, which is required.
  std::vector<Foreign> all(const std::string& tag) const;
  std::optional<Foreign> one(const std::string& tag) const;
  Foreign need(const std::string& tag) const;

  std::optional<std::string> attribute(const std::string& name) const;
  std::string name() const;  ///< the attribute "name", which is required
  std::string text() const;  ///< content of the element
  /// `count` numbers in an attribute, or in the text.
  std::vector<double> numbers(const std::string& attribute, std::size_t count) const;
  std::vector<double> numbers(std::size_t count) const;
  double number(const std::string& attribute) const { return numbers(attribute, 1)[0]; }
  double number() const { return numbers(1)[0]; }
  /// The number in a child's text, or the default if there is no such child.
  double number_in(const std::string& child, double default_value) const;

  /// Throws xml::Errors with the position of this element.
  [[noreturn]] void reject(const std::string& what, const std::string& remedy) const;

 private:
  std::vector<double> parsed(const std::string& text, std::size_t count,
                             const std::string& what) const;
  const xml::Element* element_;
};

}  // namespace formats
