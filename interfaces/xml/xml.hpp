#pragma once
#include "interfaces/xml/describe.hpp"
#include "interfaces/xml/reader.hpp"
#include "interfaces/xml/schema.hpp"
#include "interfaces/xml/set.hpp"
#include "interfaces/xml/writer.hpp"

/// Structs from XML and back, their XSD, their help, and single values set by path. See README.md.
namespace xml {

/// Refuses a root element of another name.
std::vector<Error> wrong_root(const Element& root, const std::string& expected);

/// An element's text with the XML declaration in front.
std::string file_text(const std::string& element);

/// Fills `value` (which keeps its defaults where the file says nothing) from a file whose root
/// element is <root>. Throws Errors with every mistake in the file.
template <class T>
void read_into(T& value, const Element& root, const std::string& root_name) {
  throw_if_any(wrong_root(root, root_name));
  std::vector<Error> errors;
  Reader::fill(value, root, errors);
  throw_if_any(std::move(errors));
}
template <class T>
void read_into(T& value, const std::string& file, const std::string& root_name) {
  read_into(value, read_document(file), root_name);
}

/// A struct with an `element` name of its own, from a file. Throws Errors.
template <class T>
T read(const std::string& file) {
  T value;
  read_into(value, file, T::element);
  return value;
}

/// The same from a text; `label` stands for the file's name in errors.
template <class T>
T parse(std::string_view text, const std::string& label) {
  T value;
  read_into(value, parse_document(text, label), T::element);
  return value;
}

/// The struct as the text of a file; reads back to the same bits. What equals its default is left
/// out. Needs a copyable struct, because `visit` is not const.
template <class T>
std::string write(const T& value, const std::string& root_name) {
  T copy = value;
  return file_text(Writer::text_of(copy, root_name, 0));
}
template <class T>
std::string write(const T& value) {
  return write(value, T::element);
}

/// The XSD 1.0 of a file that holds one T as its root element.
template <class T>
std::string schema(const std::string& root_name) {
  return schema_document(root_name, Schema::type_of<T>());
}
template <class T>
std::string schema() {
  return schema<T>(T::element);
}

/// Names, types, ranges and defaults, one a line; for --help.
template <class T>
std::string describe() {
  std::vector<Description> all;
  T fresh{};
  Describer describer(all);
  fresh.visit(describer);
  return to_table(all);
}

/// Sets one value by its path (`gain`, `spindle.radius_m`, `flexor.gain`), with the checks that a
/// file gets. Throws Errors and changes nothing when the path is unknown or the text is refused.
template <class T>
void set(T& params, const std::string& path, const std::string& text) {
  Setter setter(path, text);
  params.visit(setter);
  setter.finish(path);
}

}  // namespace xml
