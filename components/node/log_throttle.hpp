#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

/// Limits repeated reports: passes the first few of a kind, then only counts them. Reads no clock.
namespace node {

class LogThrottle {
 public:
  static constexpr int burst = 3;  ///< reports per kind and window, chosen
  static constexpr std::int64_t window_ns = 10'000'000'000;  ///< chosen
  static constexpr std::size_t max_kinds = 512;              ///< chosen; further kinds count as one

  /// Returns std::nullopt when this kind was reported `burst` times within the window; otherwise
  /// the number of reports suppressed since the last one that passed.
  std::optional<unsigned> admit(const std::string& kind, std::int64_t now_ns) {
    const bool is_full = kinds_.size() >= max_kinds && !kinds_.contains(kind);
    Window& window = kinds_[is_full ? "" : kind];
    if (now_ns - window.start_ns > window_ns || window.count == 0)
      window.start_ns = now_ns, window.count = 0;
    if (window.count == burst) {
      ++window.suppressed;
      return std::nullopt;
    }
    ++window.count;
    return std::exchange(window.suppressed, 0U);
  }

 private:
  struct Window {
    std::int64_t start_ns = 0;
    int count = 0;
    unsigned suppressed = 0;
  };
  std::map<std::string, Window> kinds_;
};

}  // namespace node
