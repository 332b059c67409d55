#pragma once
#include <list>
#include <string>

#include "interfaces/xml/writer.hpp"

namespace xml {

/// An element that is built step by step, for formats of other programs.
struct Tree {
  std::string name;
  std::vector<WrittenAttribute> attributes;
  std::string text;          ///< instead of children
  std::list<Tree> children;  ///< references stay valid when others are added

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

/// A whole document, with its XML declaration.
std::string write_tree(const Tree& root);

}  // namespace xml
