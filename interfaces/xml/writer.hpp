#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "interfaces/xml/renamed.hpp"
#include "interfaces/xml/values.hpp"

namespace xml {

/// An attribute to be written: name and unescaped text.
using WrittenAttribute = std::pair<std::string, std::string>;

/// The text with the special characters of XML and HTML replaced by entities.
std::string escaped(const std::string& text);

/// The XML declaration followed by an element's text.
std::string file_text(const std::string& element);

/// One element as text, indented; attributes wrap at 100 columns.
std::string element_text(const std::string& name, const std::vector<WrittenAttribute>& attributes,
                         const std::string& children, std::size_t depth);

/// The same for an element that contains text.
std::string text_element(const std::string& name, const std::vector<WrittenAttribute>& attributes,
                         const std::string& text, std::size_t depth);

/// Writes a struct through its `visit`. Omits optional attributes that equal their default.
class Writer : public CurrentNamesOnly {
 public:
  explicit Writer(std::size_t depth = 0, std::vector<WrittenAttribute> defaults = {})
      : depth_(depth), defaults_(std::move(defaults)) {}

  template <class T>
  void operator()(const char* name, const T& value, const Field& = {}) {
    if (!has_value(value)) return;
    WrittenAttribute attribute{name, Codec<T>::write(value)};
    const auto end = defaults_.end();
    if (std::find(defaults_.begin(), end, attribute) == end)
      attributes_.push_back(std::move(attribute));
  }
  template <class T>
  void required(const char* name, const T& value, const Field& = {}) {
    if (has_value(value)) attributes_.emplace_back(name, Codec<T>::write(value));
  }
  template <class T>
  void child(T& value) {
    children_ += text_of(value, T::element, depth_ + 1);
  }
  template <class T>
  void optional_child(std::optional<T>& value) {
    if (value) child(*value);
  }
  template <class T>
  void list(std::vector<T>& values) {
    for (T& value : values) child(value);
  }
  template <class... Kinds>
  void list(std::vector<std::variant<Kinds...>>& values) {
    for (auto& value : values) std::visit([this](auto& kind) { child(kind); }, value);
  }

  void rest(const std::vector<Attribute>& values) {
    for (const Attribute& a : values) attributes_.emplace_back(a.name, a.value);
  }

  /// `value` as the element `<name>`. Does not change `value`; it is not const because `visit` is
  /// not.
  template <class T>
  static std::string text_of(T& value, const std::string& name, std::size_t depth) {
    Writer writer(depth, attributes_of_default<T>());
    value.visit(writer);
    return element_text(name, writer.attributes_, writer.children_, depth);
  }

 private:
  template <class T>
  static bool has_value(const T& value) {
    if constexpr (is_optional<T>) return value.has_value();
    else return true;
  }
  template <class T>
  static std::vector<WrittenAttribute> attributes_of_default() {
    T item{};
    Writer writer;
    item.visit(writer);
    return writer.attributes_;
  }

  std::size_t depth_;
  std::vector<WrittenAttribute> defaults_, attributes_;
  std::string children_;
};

}  // namespace xml
