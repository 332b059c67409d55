#include "interfaces/xml/set.hpp"

#include "interfaces/xml/renamed.hpp"

namespace xml {

Refused Setter::outcome() const {
  if (found_) return refused_;
  return Refusal{"unknown parameter " + quote(head_), did_you_mean(head_, known_)};
}

void Setter::former(const char* former_name, const char* name) {
  if (!tail_.empty() || head_ != former_name) return;
  warn_renamed({"--set " + std::string(head_) + "=" + std::string(text_), 0, 0}, former_name, name);
  head_ = name;
}

void Setter::finish(std::string_view path) const {
  if (const Refused refused = outcome())
    throw Errors({{{"--set " + std::string(path) + "=" + std::string(text_), 0, 0},
                   refused->what,
                   refused->remedy}});
}

}  // namespace xml
