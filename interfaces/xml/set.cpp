#include "interfaces/xml/set.hpp"

#include "interfaces/xml/renamed.hpp"

namespace xml {

std::optional<ValueError> Setter::result() const {
  if (is_found_) return error_;
  return ValueError{"unknown parameter " + quote(name_), did_you_mean(name_, valid_names_)};
}

void Setter::former(const char* former_name, const char* name) {
  if (!inner_path_.empty() || name_ != former_name) return;
  warn_renamed({"--set " + std::string(name_) + "=" + std::string(text_), 0, 0}, former_name, name);
  name_ = name;
}

void Setter::finish(std::string_view path) const {
  if (const std::optional<ValueError> error = result())
    throw Errors({{{"--set " + std::string(path) + "=" + std::string(text_), 0, 0},
                   error->what,
                   error->remedy}});
}

}  // namespace xml
