#include "components/plant/notice.hpp"

#include <algorithm>

namespace plant {
namespace {

constexpr std::size_t min_group = 3;  // chosen
constexpr std::size_t max_names = 3;  // chosen

bool differ_in_subject_only(const Notice& a, const Notice& b) {
  return a.severity == b.severity && a.code == b.code && a.text == b.text && !a.subject.empty() &&
         !b.subject.empty();
}

std::string names_of(const std::vector<Notice>& group) {
  std::string names;
  for (std::size_t i = 0; i < std::min(max_names, group.size()); ++i)
    names += (i ? ", " : "") + group[i].subject;
  return group.size() > max_names ? names + " …" : names;
}

Notice merge(const std::vector<Notice>& group, std::size_t actuators) {
  Notice merged = group.front();
  const bool all = group.size() == actuators;
  if (!all) merged.text += " (" + names_of(group) + ")";
  merged.subject = (all ? "all " : "") + std::to_string(group.size()) + " actuators";
  return merged;
}

}  // namespace

std::vector<Notice> merge_similar(std::vector<Notice> notices, std::size_t actuators) {
  std::vector<Notice> merged;
  while (!notices.empty()) {
    const auto others = std::stable_partition(
        notices.begin(), notices.end(),
        [first = notices.front()](const Notice& n) { return differ_in_subject_only(n, first); });
    std::vector<Notice> group(notices.begin(), std::max(others, notices.begin() + 1));
    notices.erase(notices.begin(), notices.begin() + static_cast<std::ptrdiff_t>(group.size()));
    if (group.size() >= min_group) merged.push_back(merge(group, actuators));
    else merged.insert(merged.end(), group.begin(), group.end());
  }
  return merged;
}

}  // namespace plant
