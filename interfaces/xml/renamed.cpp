#include "interfaces/xml/renamed.hpp"

#include <cstdio>
#include <mutex>
#include <set>
#include <utility>

#include "interfaces/xml/errors.hpp"
#include "interfaces/xml/words.hpp"

namespace xml {

void warn_renamed(const Place& place, const std::string& former, const std::string& current) {
  static std::mutex mutex;
  static std::set<std::pair<std::string, std::string>> reported;
  const std::lock_guard lock(mutex);
  if (!reported.emplace(place.file, former).second) return;
  const auto name = [](const std::string& text) {
    return text.starts_with('<') ? text : quote(text);
  };
  const std::string line =
      to_string({place, name(former) + " is deprecated", "write " + name(current)});
  std::fprintf(stderr, "warning: %s\n", line.c_str());
}

}  // namespace xml
