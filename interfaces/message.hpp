#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>

/// Messages on the bus: the generated C structs with value semantics and their own storage.
namespace erp {

/// Capacity of a bounded IDL sequence. `topics.hpp` repeats the bounds of
/// `interfaces/idl/sizes.idl`.
template <class Element>
inline constexpr std::size_t capacity_of = 64;

/// The used elements of an IDL sequence.
template <class Sequence>
auto samples(Sequence& sequence) {
  return std::span(sequence._buffer, sequence._length);
}

/// Appends an element to an IDL sequence. Throws std::length_error when it is full.
template <class Sequence, class Element>
Element& append(Sequence& sequence, const Element& element) {
  if (sequence._length >= sequence._maximum)
    throw std::length_error("message full: at most " + std::to_string(sequence._maximum) +
                            " elements");
  return sequence._buffer[sequence._length++] = element;
}

/// Copies text into a bounded IDL string. Throws std::length_error when it does not fit.
template <std::size_t N>
void assign(char (&field)[N], std::string_view text) {
  if (text.size() >= N)
    throw std::length_error("\"" + std::string(text) + "\" is longer than " +
                            std::to_string(N - 1) + " characters");
  std::copy(text.begin(), text.end(), field);
  std::fill(field + text.size(), field + N, '\0');
}

/// Copies a text and truncates it if it is too long; for notes and reasons.
template <std::size_t N>
void assign_shortened(char (&field)[N], std::string_view text) {
  assign(field, text.substr(0, N - 1));
}

namespace detail {
template <class>
struct member_type;
template <class Struct, class Field>
struct member_type<Field Struct::*> {
  using type = Field;
};
template <auto Member>
using sequence_of = typename member_type<decltype(Member)>::type;
template <auto Member>
using element_of = std::remove_pointer_t<decltype(sequence_of<Member>::_buffer)>;
}  // namespace detail

/// A generated C struct together with the storage of its sequences: copyable, without heap
/// allocation. A copy contains only the used elements.
template <class WireStruct, auto... Members>
struct Message : WireStruct {
  using Wire = WireStruct;

  Message() : Wire{} { attach_storage(); }
  Message(const Message& other) : Wire(other) { attach_storage(), copy_elements(other); }
  Message& operator=(const Message& other) {
    if (this != &other) Wire::operator=(other), attach_storage(), copy_elements(other);
    return *this;
  }
  ~Message() = default;

  /// Points every sequence at this message's own storage; keeps the lengths.
  void attach_storage() {
    std::apply([this](auto&... storage) { (attach_one<Members>(storage), ...); }, storage_);
  }
  void clear() {
    Wire::operator=(Wire{});
    attach_storage();
  }

 private:
  template <auto Member, class Storage>
  void attach_one(Storage& storage) {
    auto& field = this->*Member;
    field._maximum = static_cast<std::uint32_t>(storage.size());
    field._buffer = storage.data();
    field._release = false;
  }
  void copy_elements(const Message& other) {
    (std::copy_n((other.*Members)._buffer, (other.*Members)._length, (this->*Members)._buffer),
     ...);
  }

  std::tuple<std::array<detail::element_of<Members>, capacity_of<detail::element_of<Members>>>...>
      storage_;
};

}  // namespace erp
