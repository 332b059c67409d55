#pragma once
#include <string>

#include "interfaces/xml/fields.hpp"

/// Former names of elements, attributes, keys and options, which are still read.
namespace xml {

/// Prints `warning: place: "former" is deprecated; write "now"` on stderr, once per file and name in
/// a process.
void warn_renamed(const Place& place, const std::string& former, const std::string& now);

/// Whether `name` is the name of the element of a T or its former name, `T::former_element`.
template <class T>
bool is_element_name(const std::string& name) {
  if constexpr (requires { T::former_element; })
    if (name == T::former_element) return true;
  return name == T::element;
}

/// Warns if `name` at `place` is the former name of the element of a T.
template <class T>
void warn_if_former(const std::string& name, const Place& place) {
  if (name != T::element)
    warn_renamed(place, "<" + name + ">", std::string("<") + T::element + ">");
}

/// Base of the visitors that handle current names only.
struct CurrentNamesOnly {
  void former(const char* /*former_name*/, const char* /*name*/) {}
};

}  // namespace xml
