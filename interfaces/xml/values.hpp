#pragma once
#include <array>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "interfaces/xml/fields.hpp"
#include "interfaces/xml/words.hpp"

/// Reading, writing, description and XSD type of each type of attribute.
/// To support another type, specialise Codec with the same four functions.
namespace xml {

/// Reason why a text is not a valid value; follows `name="text" ` in an error message. A function
/// that returns std::optional<ValueError> returns no error for a valid text.
struct ValueError {
  std::string what, remedy;
};

/// The range as text: ` > 0`, ` from 0 to 127`; empty without limits.
std::string range_words(const Range& range);

/// Reads a finite number in decimal notation; white space around it is allowed.
std::optional<ValueError> read_number(std::string_view text, double& value, const Range& range);
std::optional<ValueError> read_integer(std::string_view text, long long& value, Range range);
std::optional<ValueError> read_flag(std::string_view text, bool& value);
std::string write_number(double value);  ///< the shortest text that reads back to the same bits
std::string write_number(float value);

/// `<xs:simpleType>` texts.
std::string xsd_restriction(const std::string& base, const Range& range);
std::string xsd_list(const std::string& item_type, std::size_t length);  ///< length 0: any
std::string xsd_words(const std::vector<std::string>& words);
std::string xsd_filled_text();  ///< a non-blank text

template <class T>
struct Codec;

template <std::floating_point T>
struct Codec<T> {
  static std::optional<ValueError> read(std::string_view text, T& value, const Range& range) {
    double number = 0;
    std::optional<ValueError> error = read_number(text, number, range);
    if (!error) value = static_cast<T>(number);
    return error;
  }
  static std::string write(T value) { return write_number(value); }
  static std::string words(const Range& range) { return "number" + range_words(range); }
  static std::string xsd(const Range& range) { return xsd_restriction("number", range); }
};

template <class T>
requires(std::integral<T> && !std::same_as<T, bool>) struct Codec<T> {
  static Range limited_to_type(Range range) {
    range.min = std::max(range.min, static_cast<double>(std::numeric_limits<T>::min()));
    range.max = std::min(range.max, static_cast<double>(std::numeric_limits<T>::max()));
    return range;
  }
  static std::optional<ValueError> read(std::string_view text, T& value, const Range& range) {
    long long number = 0;
    std::optional<ValueError> error = read_integer(text, number, limited_to_type(range));
    if (!error) value = static_cast<T>(number);
    return error;
  }
  static std::string write(T value) { return std::to_string(value); }
  static std::string words(const Range& range) { return "integer" + range_words(range); }
  static std::string xsd(const Range& range) {
    return xsd_restriction("integer", limited_to_type(range));
  }
};

template <>
struct Codec<bool> {
  static std::optional<ValueError> read(std::string_view text, bool& value, const Range&) {
    return read_flag(text, value);
  }
  static std::string write(bool value) { return value ? "true" : "false"; }
  static std::string words(const Range&) { return "true or false"; }
  static std::string xsd(const Range&) { return xsd_restriction("flag", any); }
};

template <>
struct Codec<std::string> {
  static std::optional<ValueError> read(std::string_view text, std::string& value, const Range&) {
    value = text;
    return {};
  }
  static std::string write(const std::string& value) { return value; }
  static std::string words(const Range&) { return "text"; }
  static std::string xsd(const Range&) { return xsd_restriction("xs:string", any); }
};

/// Values separated by white space: std::array of a fixed number, std::vector of any number.
template <class List, std::size_t length>
struct ListCodec {
  using Item = typename List::value_type;
  static std::optional<ValueError> read(std::string_view text, List& value, const Range& range) {
    const auto parts = split(text);
    if (length > 0 && parts.size() != length)
      return ValueError{"has " + std::to_string(parts.size()) + " values",
                        "give " + std::to_string(length) + " separated by spaces"};
    List read_items{};
    if constexpr (length == 0) read_items.resize(parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (auto error = Codec<Item>::read(parts[i], read_items[i], range)) return error;
    value = read_items;
    return {};
  }
  static std::string write(const List& value) {
    std::vector<std::string> words;
    words.reserve(value.size());
    for (const Item& item : value) words.push_back(Codec<Item>::write(item));
    return joined(words, " ");
  }
  static std::string words(const Range& range) {
    return (length ? std::to_string(length) + " × " : "list of ") + Codec<Item>::words(range);
  }
  static std::string xsd(const Range& range) { return xsd_list(Codec<Item>::xsd(range), length); }
};
template <class T, std::size_t N>
struct Codec<std::array<T, N>> : ListCodec<std::array<T, N>, N> {};
template <class T>
struct Codec<std::vector<T>> : ListCodec<std::vector<T>, 0> {};

template <class T>
struct Codec<std::optional<T>> {
  static std::optional<ValueError> read(std::string_view text, std::optional<T>& value,
                                        const Range& range) {
    T inner{};
    std::optional<ValueError> error = Codec<T>::read(text, inner, range);
    if (!error) value = inner;
    return error;
  }
  static std::string write(const std::optional<T>& value) {
    return value ? Codec<T>::write(*value) : "";
  }
  static std::string words(const Range& range) { return Codec<T>::words(range); }
  static std::string xsd(const Range& range) { return Codec<T>::xsd(range); }
};

template <class Enum>
requires std::is_enum_v<Enum>
struct Codec<Enum> {
  static std::vector<std::string> all_words() {
    std::vector<std::string> words;
    words.reserve(Names<Enum>::list.size());
    for (const auto& [word, value] : Names<Enum>::list) words.push_back(word);
    return words;
  }
  static std::optional<ValueError> read(std::string_view text, Enum& value, const Range&) {
    for (const auto& [word, named] : Names<Enum>::list)
      if (text == word) return value = named, std::optional<ValueError>{};
    const std::string nearest_word = nearest(text, all_words());
    return ValueError{
        "is not one of " + joined(all_words()),
        nearest_word.empty() ? "choose one of them" : "did you mean " + quote(nearest_word) + "?"};
  }
  static std::string write(Enum value) {
    for (const auto& [word, named] : Names<Enum>::list)
      if (value == named) return word;
    return "";
  }
  static std::string words(const Range&) { return joined(all_words(), " | "); }
  static std::string xsd(const Range&) { return xsd_words(all_words()); }
};

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

}  // namespace xml
