#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "interfaces/xml/errors.hpp"
#include "interfaces/xml/values.hpp"

namespace xml {

/// Sets one attribute by its path: `gain`, `spindle.radius_m` for a single child, and
/// `flexor.gain` for the list item whose `name` is flexor. Call `finish` after the visit.
class Setter {
 public:
  Setter(std::string_view path, std::string_view text) : text_(text) {
    const std::size_t dot = path.find('.');
    head_ = path.substr(0, dot);
    if (dot != path.npos) tail_ = path.substr(dot + 1);
  }

  template <class T>
  void operator()(const char* name, T& value, const Field& field = {}) {
    known_.push_back(name);
    if (!tail_.empty() || head_ != name) return;
    found_ = true;
    refused_ = Codec<T>::read(text_, value, field.range);
  }
  template <class T>
  void required(const char* name, T& value, const Field& field = {}) {
    (*this)(name, value, field);
  }
  /// From now on the attribute `name` is also set under its former name.
  void former(const char* former_name, const char* name);

  void rest(std::vector<Attribute>& values) {
    for (Attribute& attribute : values) {
      known_.push_back(attribute.name.c_str());
      if (!tail_.empty() || head_ != attribute.name) continue;
      found_ = true;
      attribute.value = text_;
    }
  }
  template <class T>
  void child(T& value) {
    enter(T::element, value);
  }
  template <class T>
  void optional_child(std::optional<T>& value) {
    if (value) enter(T::element, *value);
    else if (head_ == T::element) enter(T::element, value.emplace());
  }
  template <class T>
  void list(std::vector<T>& values) {
    for (T& value : values)
      if constexpr (requires { value.name; }) enter(value.name, value);
  }
  template <class... Kinds>
  void list(std::vector<std::variant<Kinds...>>& values) {
    for (auto& value : values)
      std::visit(
          [this](auto& kind) {
            if constexpr (requires { kind.name; }) enter(kind.name, kind);
          },
          value);
  }

  /// Throws Errors when no attribute has that path or the text was refused. `path`: the full path, for
  /// the error.
  void finish(std::string_view path) const;

 private:
  template <class T>
  void enter(const std::string& name, T& value) {
    known_.push_back(name);
    if (tail_.empty() || head_ != name) return;
    Setter inner(tail_, text_);
    value.visit(inner);
    found_ = true;
    refused_ = inner.outcome();
  }
  Refused outcome() const;

  std::string_view head_, tail_, text_;
  std::vector<std::string> known_;
  bool found_ = false;
  Refused refused_;
};

}  // namespace xml
