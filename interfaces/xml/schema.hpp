#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "interfaces/xml/describe.hpp"
#include "interfaces/xml/renamed.hpp"
#include "interfaces/xml/values.hpp"

namespace xml {

/// Attributes and children that one `visit` lists, for the XSD.
struct SchemaParts {
  struct Attribute {
    std::string name, type;  ///< type: an `<xs:simpleType>`
    bool required = false;
    std::string description = "";
  };
  struct Child {
    std::string name, type;  ///< type: an `<xs:complexType>`
    enum Count { one, optional, any_number } count = one;
    std::string description = "";
  };
  std::vector<Attribute> attributes;
  std::vector<Child> children;
  bool allows_others = false;  ///< attributes with other names are allowed
};

/// `<xs:complexType>` of an element. In XSD 1.0, unordered children (xs:all) occur at most once
/// each: a struct has either single children or lists. Throws std::logic_error for a struct with
/// both.
std::string complex_type(const SchemaParts& parts);

/// The XSD document with the type of the root element, one tag per line, indented.
std::string schema_document(const std::string& root_name, const std::string& root_type);

/// Derives the XSD type of a struct from its `visit`.
class Schema : public CurrentNamesOnly {
 public:
  template <class T>
  void operator()(const char* name, const T&, const Field& field = {}) {
    parts_.attributes.push_back({name, Codec<T>::xsd(field.range), false, field.description});
  }
  template <class T>
  void required(const char* name, const T&, const Field& field = {}) {
    const bool text = std::is_same_v<T, std::string>;
    parts_.attributes.push_back(
        {name, text ? xsd_filled_text() : Codec<T>::xsd(field.range), true, field.description});
  }
  template <class T>
  void child(T&) {
    add<T>(SchemaParts::Child::one);
  }
  template <class T>
  void optional_child(std::optional<T>&) {
    add<T>(SchemaParts::Child::optional);
  }
  template <class T>
  void list(std::vector<T>&) {
    add<T>(SchemaParts::Child::any_number);
  }
  template <class... Kinds>
  void list(std::vector<std::variant<Kinds...>>&) {
    (add<Kinds>(SchemaParts::Child::any_number), ...);
  }

  void rest(const std::vector<Attribute>&) { parts_.allows_others = true; }

  template <class T>
  static std::string type_of() {
    T item{};
    Schema schema;
    item.visit(schema);
    return complex_type(schema.parts_);
  }

 private:
  template <class T>
  void add(SchemaParts::Child::Count count) {
    parts_.children.push_back({T::element, type_of<T>(), count, description_of_element<T>()});
  }
  SchemaParts parts_;
};

}  // namespace xml
