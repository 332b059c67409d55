#include "interfaces/xml/set.hpp"

namespace xml {

Refused Setter::outcome() const {
  if (found_) return refused_;
  return Refusal{"unknown parameter " + quote(head_), did_you_mean(head_, known_)};
}

void Setter::finish(std::string_view path) const {
  if (const Refused refused = outcome())
    throw Errors({{{"--set " + std::string(path) + "=" + std::string(text_), 0, 0},
                   refused->what,
                   refused->remedy}});
}

}  // namespace xml
