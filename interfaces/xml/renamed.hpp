#pragma once
#include <string>

#include "interfaces/xml/fields.hpp"

/// Former names of elements, attributes, keys and options, which are still read.
namespace xml {

/// Prints `warning: place: "former" is deprecated; write "current"` on stderr, once per process,
/// file and name.
void warn_renamed(const Place& place, const std::string& former, const std::string& current);

/// Whether `name` is `T::element` or its former name, `T::former_element`.
template <class T>
bool is_element_name(const std::string& name) {
  if constexpr (requires { T::former_element; })
    if (name == T::former_element) return true;
  return name == T::element;
}

/// Warns if `name` at `place` is the former element name of T.
template <class T>
void warn_if_former(const std::string& name, const Place& place) {
  if (name != T::element)
    warn_renamed(place, "<" + name + ">", std::string("<") + T::element + ">");
}

/// Base of the visitors that ignore former names.
struct CurrentNamesOnly {
  void former(const char* /*former_name*/, const char* /*name*/) {}
};

}  // namespace xml
