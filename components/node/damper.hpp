#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

/// What is said again and again is said a few times, then only counted. Pure.
namespace node {

class Damper {
 public:
  static constexpr int burst = 3;                            ///< of one kind, chosen
  static constexpr std::int64_t window_ns = 10'000'000'000;  ///< chosen

  /// Nothing when this kind was said `burst` times within the window; else how many of it were
  /// kept back since it was said last.
  std::optional<unsigned> admit(const std::string& kind, std::int64_t now_ns) {
    Said& said = kinds_[kind];
    if (now_ns - said.since_ns > window_ns || said.count == 0)
      said.since_ns = now_ns, said.count = 0;
    if (said.count == burst) {
      ++said.kept_back;
      return std::nullopt;
    }
    ++said.count;
    return std::exchange(said.kept_back, 0U);
  }

 private:
  struct Said {
    std::int64_t since_ns = 0;
    int count = 0;
    unsigned kept_back = 0;
  };
  std::map<std::string, Said> kinds_;
};

}  // namespace node
