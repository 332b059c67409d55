#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "interfaces/xml/renamed.hpp"
#include "interfaces/xml/values.hpp"

namespace xml {

/// One line of `--help` and of `erp help`: an attribute (its unit is part of the name) or an
/// element.
struct Description {
  std::string name, type, default_text;
  bool required = false;
  std::string description = "";
  bool is_element = false;
};

/// The description of an element: `static constexpr auto description` of its struct; empty without
/// one.
template <class T>
std::string description_of_element() {
  if constexpr (requires { T::description; }) return T::description;
  else return "";
}

/// One parameter per line, columns aligned: name, type with range, unit, default, description.
std::string to_table(const std::vector<Description>& descriptions);

/// Describes a struct by its `visit`; attributes of children are indented below their element.
class Describer : public CurrentNamesOnly {
 public:
  explicit Describer(std::vector<Description>& descriptions, std::string indent = "")
      : descriptions_(descriptions), indent_(std::move(indent)) {}

  template <class T>
  void operator()(const char* name, const T& value, const Field& field = {}) {
    descriptions_.push_back({indent_ + name, Codec<T>::words(field.range), Codec<T>::write(value),
                             false, field.description});
  }
  template <class T>
  void required(const char* name, const T&, const Field& field = {}) {
    descriptions_.push_back(
        {indent_ + name, Codec<T>::words(field.range), "", true, field.description});
  }
  void rest(const std::vector<Attribute>&) {
    descriptions_.push_back({indent_ + "…", "further attributes, depending on the type", "", false,
                             "Parameters of the type."});
  }
  template <class T>
  void child(T& value) {
    add_element<T>("one");
    add_members(value);
  }
  template <class T>
  void optional_child(std::optional<T>&) {
    T item{};
    add_element<T>("one or none");
    add_members(item);
  }
  template <class T>
  void list(std::vector<T>&) {
    T item{};
    add_element<T>("any number");
    add_members(item);
  }
  template <class... Kinds>
  void list(std::vector<std::variant<Kinds...>>&) {
    (list(std::vector<Kinds>{}), ...);
  }

 private:
  template <class T>
  void add_element(const char* count) {
    descriptions_.push_back(
        {indent_ + "<" + T::element + ">", count, "", false, description_of_element<T>(), true});
  }
  template <class T>
  void list(std::vector<T>&& empty) {
    list(empty);
  }
  template <class T>
  void add_members(T& value) {
    Describer inner(descriptions_, indent_ + "  ");
    value.visit(inner);
  }

  std::vector<Description>& descriptions_;
  std::string indent_;
};

}  // namespace xml
