#pragma once
#include <list>
#include <string>

#include "interfaces/xml/writer.hpp"

namespace xml {

/// An element that code builds step by step, for file formats of other programs.
struct Tree {
  std::string name;
  std::vector<WrittenAttribute> attributes;
  std::string text;          ///< if not empty, written instead of children
  std::list<Tree> children;  ///< a list: references stay valid when children are added

  explicit Tree(std::string tag) : name(std::move(tag)) {}
  Tree& add(std::string tag) { return children.emplace_back(std::move(tag)); }
  /// A child that holds text.
  Tree& add(std::string tag, std::string words) {
    Tree& child = add(std::move(tag));
    child.text = std::move(words);
    return child;
  }
  template <class T>
  Tree& set(std::string key, const T& value) {
    attributes.emplace_back(std::move(key), Codec<T>::write(value));
    return *this;
  }
  Tree& set(std::string key, const char* value) { return set(std::move(key), std::string(value)); }
};

/// The document as text, with its XML declaration.
std::string write_tree(const Tree& root);

}  // namespace xml
