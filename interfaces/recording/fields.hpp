#pragma once
#include <string>
#include <string_view>

#include "interfaces/recording/cdr.hpp"
#include "interfaces/recording/table.hpp"

/// Fields of a decoded message by name. A missing field gives NaN, 0, an empty text or no elements.
namespace recording {

inline double number_in(const Members& members, std::string_view field) {
  const Value* value = members.find(field);
  return value ? value->number().value_or(not_taken) : not_taken;
}
/// Bit flags; 0 if the field is not a 32-bit number.
inline std::uint32_t flags_in(const Members& members, std::string_view field) {
  const double number = number_in(members, field);
  return number >= 0 && number <= 0xFFFF'FFFF ? static_cast<std::uint32_t>(number) : 0;
}
inline std::string text_in(const Members& members, std::string_view field) {
  const Value* value = members.find(field);
  return value && value->text() ? *value->text() : std::string();
}
template <class Callback>
void each_in(const Members& members, std::string_view field, Callback&& callback) {
  const Value* value = members.find(field);
  if (!value || !value->elements()) return;
  for (const Value& element : *value->elements())
    if (element.members()) callback(*element.members());
}
template <class Integer>
Integer integer_in(const Members& members, std::string_view field) {
  const Value* value = members.find(field);
  const Integer* number = value ? std::get_if<Integer>(&value->data) : nullptr;
  return number ? *number : Integer{0};
}

}  // namespace recording
