#include "interfaces/xml/xml.hpp"

namespace xml {

std::vector<Error> wrong_root(const Element& root, const std::string& expected) {
  if (root.name == expected) return {};
  return {error_in(root.name, root.place, "the root element must be <" + expected + ">",
                   did_you_mean(root.name, {expected}))};
}

std::string file_text(const std::string& element) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + element;
}

}  // namespace xml
