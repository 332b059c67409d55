#pragma once
#include "interfaces/xml/describe.hpp"
#include "interfaces/xml/reader.hpp"
#include "interfaces/xml/schema.hpp"
#include "interfaces/xml/set.hpp"
#include "interfaces/xml/writer.hpp"

/// Reads and writes structs as XML; generates their XSD and help; sets single values by path. See
/// README.md.
namespace xml {

/// Fills `value` from a file with the root element `<root_name>`. Attributes that the file lacks
/// keep their defaults. Throws Errors with all errors of the file.
template <class T>
void read_into(T& value, const Element& root, const std::string& root_name) {
  if constexpr (requires { T::former_element; }) {
    if (root_name == T::element && root.name == T::former_element) {
      warn_if_former<T>(root.name, root.place);
      return read_into(value, root, root.name);
    }
  }
  throw_if_any(wrong_root(root, root_name));
  std::vector<Error> errors;
  Reader::fill(value, root, errors);
  throw_if_any(std::move(errors));
}
template <class T>
void read_into(T& value, const std::string& file, const std::string& root_name) {
  read_into(value, read_document(file), root_name);
}

/// Reads a struct that defines `element` from a file. Throws Errors.
template <class T>
T read(const std::string& file) {
  T value;
  read_into(value, file, T::element);
  return value;
}

/// The same from a text; `label` replaces the file name in errors.
template <class T>
T parse(std::string_view text, const std::string& label) {
  T value;
  read_into(value, parse_document(text, label), T::element);
  return value;
}

/// The struct as the text of a file, which reads back bit-equal. Omits optional attributes that
/// equal their default. The struct must be copyable, because `visit` is not const.
template <class T>
std::string write(const T& value, const std::string& root_name) {
  T copy = value;
  return file_text(Writer::text_of(copy, root_name, 0));
}
template <class T>
std::string write(const T& value) {
  return write(value, T::element);
}

/// The XSD 1.0 of files with T as root element.
template <class T>
std::string schema(const std::string& root_name) {
  return schema_document(root_name, Schema::type_of<T>());
}
template <class T>
std::string schema() {
  return schema<T>(T::element);
}

/// Name, type, range and default of each parameter, one per line; for --help.
template <class T>
std::string describe() {
  std::vector<Description> descriptions;
  T item{};
  Describer describer(descriptions);
  item.visit(describer);
  return to_table(descriptions);
}

/// Sets one value by its path (`gain`, `spindle.radius_m`, `flexor.gain`), with the same checks as
/// in a file. Throws Errors and changes nothing when the path is unknown or the text is rejected.
template <class T>
void set(T& params, const std::string& path, const std::string& text) {
  Setter setter(path, text);
  params.visit(setter);
  setter.finish(path);
}

}  // namespace xml
