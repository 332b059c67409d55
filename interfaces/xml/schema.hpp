#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "interfaces/xml/values.hpp"

namespace xml {

/// What one `visit` says, gathered for the XSD.
struct SchemaParts {
  struct Attribute {
    std::string name, type;  ///< type: an `<xs:simpleType>`
    bool required = false;
  };
  struct Child {
    std::string name, type;  ///< type: an `<xs:complexType>`
    enum { one, optional, any_number } count = one;
  };
  std::vector<Attribute> attributes;
  std::vector<Child> children;
  bool others = false;  ///< attributes of other names too
};

/// `<xs:complexType>` of an element. XSD 1.0 knows unordered children (xs:all) only up to one of
/// each, so a struct has either single children or lists: throws std::logic_error for a mixture.
std::string complex_type(const SchemaParts& parts);

/// The whole document around the type of the root element, one tag a line, indented.
std::string schema_document(const std::string& root_name, const std::string& root_type);

/// Types a struct through its `visit`.
class Schema {
 public:
  template <class T>
  void operator()(const char* name, const T&, const Range& range = any) {
    parts_.attributes.push_back({name, Codec<T>::xsd(range), false});
  }
  template <class T>
  void required(const char* name, const T&, const Range& range = any) {
    const bool text = std::is_same_v<T, std::string>;
    parts_.attributes.push_back({name, text ? xsd_filled_text() : Codec<T>::xsd(range), true});
  }
  template <class T>
  void child(T&) {
    parts_.children.push_back({T::element, type_of<T>(), SchemaParts::Child::one});
  }
  template <class T>
  void optional_child(std::optional<T>&) {
    parts_.children.push_back({T::element, type_of<T>(), SchemaParts::Child::optional});
  }
  template <class T>
  void list(std::vector<T>&) {
    parts_.children.push_back({T::element, type_of<T>(), SchemaParts::Child::any_number});
  }
  template <class... Kinds>
  void list(std::vector<std::variant<Kinds...>>&) {
    (parts_.children.push_back({Kinds::element, type_of<Kinds>(), SchemaParts::Child::any_number}),
     ...);
  }

  void rest(const std::vector<Attribute>&) { parts_.others = true; }

  template <class T>
  static std::string type_of() {
    T fresh{};
    Schema schema;
    fresh.visit(schema);
    return complex_type(schema.parts_);
  }

 private:
  SchemaParts parts_;
};

}  // namespace xml
