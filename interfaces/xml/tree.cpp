#include "interfaces/xml/tree.hpp"

namespace xml {
namespace {

std::string text_of(const Tree& tree, std::size_t depth) {
  if (!tree.text.empty()) return text_element(tree.name, tree.attributes, tree.text, depth);
  std::string children;
  for (const Tree& child : tree.children) children += text_of(child, depth + 1);
  return element_text(tree.name, tree.attributes, children, depth);
}

}  // namespace

std::string write_tree(const Tree& root) { return file_text(text_of(root, 0)); }

}  // namespace xml
