#pragma once
#include <optional>
#include <string>
#include <vector>

#include "interfaces/xml/document.hpp"

/// An element of a format that is not ours: what we do not know in it is left alone; what we need
/// and is missing or is no number is an error with its place. Throws xml::Errors.
namespace formats {

class Foreign {
 public:
  explicit Foreign(const xml::Element& element) : element_(&element) {}

  const xml::Element& element() const { return *element_; }
  std::vector<Foreign> children() const {
    return {element_->children.begin(), element_->children.end()};
  }
  const std::string& tag() const { return element_->name; }
  std::vector<Foreign> all(const std::string& tag) const;
  std::optional<Foreign> one(const std::string& tag) const;
  Foreign need(const std::string& tag) const;

  std::optional<std::string> attribute(const std::string& name) const;
  std::string name() const;  ///< the attribute "name", which must stand there
  std::string text() const;  ///< between its tags
  /// So many numbers in an attribute, or in the text.
  std::vector<double> numbers(const std::string& attribute, std::size_t count) const;
  std::vector<double> numbers(std::size_t count) const;
  double number(const std::string& attribute) const { return numbers(attribute, 1)[0]; }
  double number() const { return numbers(1)[0]; }
  /// Of the child's text, or what is usual.
  double number_in(const std::string& child, double usual) const;

  [[noreturn]] void refuse(const std::string& what, const std::string& remedy) const;

 private:
  std::vector<double> parsed(const std::string& text, std::size_t count,
                             const std::string& what) const;
  const xml::Element* element_;
};

}  // namespace formats
