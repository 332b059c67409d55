#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "interfaces/xml/values.hpp"

namespace xml {

/// One line of `--help`: a parameter with its type, range and default.
struct Description {
  std::string name, type, default_text;
  bool required = false;
};

/// One a line, columns aligned: `gain     number > 0    default 2.5`.
std::string to_table(const std::vector<Description>& all);

/// Describes a struct through its `visit`; children are indented below their element.
class Describer {
 public:
  explicit Describer(std::vector<Description>& all, std::string indent = "")
      : all_(all), indent_(std::move(indent)) {}

  template <class T>
  void operator()(const char* name, const T& value, const Range& range = any) {
    all_.push_back({indent_ + name, Codec<T>::words(range), Codec<T>::write(value), false});
  }
  template <class T>
  void required(const char* name, const T&, const Range& range = any) {
    all_.push_back({indent_ + name, Codec<T>::words(range), "", true});
  }
  void rest(const std::vector<Attribute>&) {
    all_.push_back({indent_ + "…", "attributes as its type has them", "", false});
  }
  template <class T>
  void child(T& value) {
    all_.push_back({indent_ + "<" + T::element + ">", "one", "", false});
    inside(value);
  }
  template <class T>
  void optional_child(std::optional<T>&) {
    T fresh{};
    all_.push_back({indent_ + "<" + T::element + ">", "one or none", "", false});
    inside(fresh);
  }
  template <class T>
  void list(std::vector<T>&) {
    T fresh{};
    all_.push_back({indent_ + "<" + T::element + ">", "any number", "", false});
    inside(fresh);
  }
  template <class... Kinds>
  void list(std::vector<std::variant<Kinds...>>&) {
    (list(std::vector<Kinds>{}), ...);
  }

 private:
  template <class T>
  void list(std::vector<T>&& none) {
    list(none);
  }
  template <class T>
  void inside(T& value) {
    Describer inner(all_, indent_ + "  ");
    value.visit(inner);
  }

  std::vector<Description>& all_;
  std::string indent_;
};

}  // namespace xml
