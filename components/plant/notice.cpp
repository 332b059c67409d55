#include "components/plant/notice.hpp"

#include <algorithm>

namespace plant {
namespace {

constexpr std::size_t many = 3;   // chosen
constexpr std::size_t named = 3;  // chosen

bool alike(const Notice& a, const Notice& b) {
  return a.severity == b.severity && a.code == b.code && a.text == b.text && !a.subject.empty() &&
         !b.subject.empty();
}

std::string names_of(const std::vector<Notice>& group) {
  std::string names;
  for (std::size_t i = 0; i < std::min(named, group.size()); ++i)
    names += (i ? ", " : "") + group[i].subject;
  return group.size() > named ? names + " …" : names;
}

Notice count(const std::vector<Notice>& group, std::size_t actuators) {
  Notice one = group.front();
  const bool all = group.size() == actuators;
  if (!all) one.text += " (" + names_of(group) + ")";
  one.subject = (all ? "all " : "") + std::to_string(group.size()) + " actuators";
  return one;
}

}  // namespace

std::vector<Notice> together(std::vector<Notice> notices, std::size_t actuators) {
  std::vector<Notice> said;
  while (!notices.empty()) {
    const auto others = std::stable_partition(
        notices.begin(), notices.end(),
        [first = notices.front()](const Notice& n) { return alike(n, first); });
    std::vector<Notice> group(notices.begin(), std::max(others, notices.begin() + 1));
    notices.erase(notices.begin(), notices.begin() + static_cast<std::ptrdiff_t>(group.size()));
    if (group.size() >= many) said.push_back(count(group, actuators));
    else said.insert(said.end(), group.begin(), group.end());
  }
  return said;
}

}  // namespace plant
