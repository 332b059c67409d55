#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "interfaces/xml/errors.hpp"
#include "interfaces/xml/values.hpp"

namespace xml {

/// Sets one attribute by its path: `gain`; `spindle.radius_m` in a single child; `flexor.gain` in
/// the list item with the name flexor. Call `finish` after `visit`.
class Setter {
 public:
  Setter(std::string_view path, std::string_view text) : text_(text) {
    const std::size_t dot = path.find('.');
    name_ = path.substr(0, dot);
    if (dot != path.npos) inner_path_ = path.substr(dot + 1);
  }

  template <class T>
  void operator()(const char* name, T& value, const Field& field = {}) {
    valid_names_.push_back(name);
    if (!inner_path_.empty() || name_ != name) return;
    is_found_ = true;
    error_ = Codec<T>::read(text_, value, field.range);
  }
  template <class T>
  void required(const char* name, T& value, const Field& field = {}) {
    (*this)(name, value, field);
  }
  /// Declares a former name of the attribute `name`. Call it before that attribute.
  void former(const char* former_name, const char* name);

  void rest(std::vector<Attribute>& values) {
    for (Attribute& attribute : values) {
      valid_names_.push_back(attribute.name.c_str());
      if (!inner_path_.empty() || name_ != attribute.name) continue;
      is_found_ = true;
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
    else if (name_ == T::element) enter(T::element, value.emplace());
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

  /// Throws Errors when no attribute has the path or the text is not valid. `path`: the full path,
  /// for the error message.
  void finish(std::string_view path) const;

 private:
  template <class T>
  void enter(const std::string& name, T& value) {
    valid_names_.push_back(name);
    if (inner_path_.empty() || name_ != name) return;
    Setter inner(inner_path_, text_);
    value.visit(inner);
    is_found_ = true;
    error_ = inner.result();
  }
  std::optional<ValueError> result() const;

  std::string_view name_, inner_path_, text_;
  std::vector<std::string> valid_names_;
  bool is_found_ = false;
  std::optional<ValueError> error_;
};

}  // namespace xml
