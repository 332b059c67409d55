#pragma once
#include <set>
#include <string>

namespace plant {

/// Keys that have been reported. Bounded, because others choose the keys.
class ReportedOnce {
 public:
  static constexpr std::size_t max_keys = 64;  // chosen

  /// True the first time, for the first `max_keys` keys.
  bool is_new(const std::string& key) {
    return keys_.size() < max_keys && keys_.insert(key).second;
  }

 private:
  std::set<std::string> keys_;
};

}  // namespace plant
