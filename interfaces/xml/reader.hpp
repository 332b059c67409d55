#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "interfaces/xml/document.hpp"
#include "interfaces/xml/renamed.hpp"
#include "interfaces/xml/values.hpp"

namespace xml {

/// Fills a struct from an element by its `visit`, and collects all errors. Each element has its own
/// Reader. `finish` reports attributes and children that the struct does not list.
class Reader {
 public:
  Reader(const Element& element, std::vector<Error>& errors) : element_(element), errors_(errors) {}

  template <class T>
  void operator()(const char* name, T& value, const Field& field = {}) {
    known_attributes_.push_back(name);
    if (const Attribute* attribute = find_attribute(name)) read(*attribute, value, field.range);
  }

  template <class T>
  void required(const char* name, T& value, const Field& field = {}) {
    known_attributes_.push_back(name);
    const Attribute* attribute = find_attribute(name);
    if (!attribute) return void(missing_attributes_.push_back(name));
    if (std::is_same_v<T, std::string> && trimmed(attribute->value).empty())
      return add_value_error(*attribute, {"is empty", "give a text"});
    read(*attribute, value, field.range);
  }

  /// Declares a former name of the attribute `name`. Call it before that attribute.
  void former(const char* former_name, const char* name) {
    former_names_.push_back({former_name, name});
  }

  template <class T>
  void child(T& value) {
    if (const Element* element = single_child<T>()) fill(value, *element, errors_);
    else missing_children_.push_back(T::element);
  }

  template <class T>
  void optional_child(std::optional<T>& value) {
    if (const Element* element = single_child<T>()) fill(value.emplace(), *element, errors_);
  }

  template <class T>
  void list(std::vector<T>& values) {
    known_children_.push_back(T::element);
    for (const Element& child : element_.children)
      if (is_a<T>(child)) fill(values.emplace_back(), child, errors_);
  }

  template <class... Kinds>
  void list(std::vector<std::variant<Kinds...>>& values) {
    (known_children_.push_back(Kinds::element), ...);
    for (const Element& child : element_.children) (append_if_named<Kinds>(values, child), ...);
  }

  void rest(std::vector<Attribute>& values);

  /// Reports unknown and missing attributes and children, and stray text.
  void finish();

  template <class T>
  static void fill(T& value, const Element& element, std::vector<Error>& errors) {
    if constexpr (requires { value.place = element.place; }) value.place = element.place;
    Reader reader(element, errors);
    value.visit(reader);
    reader.finish();
  }

 private:
  struct FormerName {
    std::string former, current;
  };
  /// The attribute with this name, or with its former name (prints a warning); null if there is
  /// none.
  const Attribute* find_attribute(const std::string& name);
  const Attribute* exact_attribute(const std::string& name) const;
  void add_second_element_error(const Element& child, const Element& first);
  void add_value_error(const Attribute& attribute, const ValueError& error);
  void add_unknown_name_error(const std::string& kind, const Place& place, const std::string& name,
                              const std::vector<std::string>& known,
                              std::vector<std::string>& missing);

  /// Whether `child` has the element name of T. Warns if it has the former name.
  template <class T>
  bool is_a(const Element& child) {
    if (!is_element_name<T>(child.name)) return false;
    warn_if_former<T>(child.name, child.place);
    if (child.name != T::element) known_children_.push_back(child.name);
    return true;
  }
  /// The child element of type T; null if there is none. Reports a second one.
  template <class T>
  const Element* single_child() {
    known_children_.push_back(T::element);
    const Element* first = nullptr;
    for (const Element& child : element_.children) {
      if (!is_a<T>(child)) continue;
      if (first) add_second_element_error(child, *first);
      else first = &child;
    }
    return first;
  }
  template <class T>
  void read(const Attribute& attribute, T& value, const Range& range) {
    if (const std::optional<ValueError> error = Codec<T>::read(attribute.value, value, range))
      add_value_error(attribute, *error);
  }
  template <class Kind, class Variant>
  void append_if_named(std::vector<Variant>& values, const Element& child) {
    if (!is_a<Kind>(child)) return;
    values.emplace_back(Kind{});
    fill(std::get<Kind>(values.back()), child, errors_);
  }

  const Element& element_;
  std::vector<Error>& errors_;
  std::vector<FormerName> former_names_;
  std::vector<std::string> known_attributes_, known_children_;
  std::vector<std::string> missing_attributes_, missing_children_;
};

}  // namespace xml
