#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "tests/stalls.hpp"

namespace faults {

/// How often each fault is injected: ERP_INJECTIONS, or 20.
inline int injections() {
  const char* text = std::getenv("ERP_INJECTIONS");
  return text ? std::atoi(text) : 20;
}

/// Measurements of one row of the table, one per injection.
class Row {
 public:
  static constexpr double scheduling_ms = 10;  ///< delay that a busy machine may add; chosen
  /// Total stall of the machine that makes an injection invalid. Half of `scheduling_ms`; chosen.
  static constexpr double stood_still_ms = 5;

  Row(std::string fault, std::string what, double limit_ms)
      : fault_(std::move(fault)), what_(std::move(what)), limit_ms_(limit_ms) {}

  /// Whether to inject again: until `needed` injections are valid, at most ten times as many.
  bool needs_more(int needed = injections()) const {
    return counted() < needed && counted() + discarded_ < 10 * needed;
  }
  /// One injection: its time, and the time of detection or safe state (0: never). A late or undetected one
  /// is discarded if the machine stalled.
  void add(std::int64_t from_ns, std::int64_t to_ns) {
    const double took_ms = 1e-6 * double(to_ns - from_ns);
    const bool never = to_ns == 0, late = never || took_ms > limit_ms_;
    detected_ = detected_ || !never;
    if (late && !kept_time(from_ns, never ? due_ns(from_ns) : to_ns)) return discard();
    if (never) ++missed_;
    else ms_.push_back(took_ms);
  }
  /// Discards an injection that cannot be judged.
  void discard() { ++discarded_; }
  /// A further condition on an injection. A violation counts only if the machine did not stall and
  /// `may_judge` is true.
  void also(const std::string& what, std::int64_t from_ns, bool holds, bool may_judge = true) {
    INFO(fault_ << ": " << what);
    also_[what] |= holds;
    if (may_judge && judges(from_ns)) CHECK(holds);
  }
  /// Whether the machine did not stall during an injection.
  bool judges(std::int64_t from_ns) const { return kept_time(from_ns, due_ns(from_ns)); }
  /// Whether the machine stalled neither in that time nor just before.
  bool kept_time(std::int64_t from_ns, std::int64_t to_ns) const {
    return stalls_.sum_of_stalls_ms(from_ns - just_before_ns, to_ns) < stood_still_ms;
  }
  /// Prints and checks the row: no injection undetected, all within the limit plus `scheduling_ms`, and of
  /// twenty injections half within the limit. If all injections were discarded, the row is not judged; if
  /// no injection ever had the expected effect, it fails.
  void check() {
    std::ranges::sort(ms_);
    std::printf("| %-34s | %-34s | %2zu | %6.1f | %6.1f | %6.1f | %5.0f |\n", fault_.c_str(),
                what_.c_str(), ms_.size(), at(0.5), at(0.95), at(1), limit_ms_);
    if (discarded_)
      std::printf("  (%d injections discarded: late while the machine stalled)\n", discarded_);
    std::fflush(stdout);
    INFO(fault_ << ": " << what_);
    for (const auto& [what, held] : also_) {
      INFO(what);
      CHECK(held);
    }
    CHECK(detected_);
    if (counted() == 0 && discarded_ > 0) return tests::not_evaluated(fault_ + ": " + what_);
    CHECK(counted() > 0);
    CHECK(missed_ == 0);
    CHECK((ms_.size() < 20 || at(0.5) <= limit_ms_));
    CHECK(at(1) <= limit_ms_ + scheduling_ms);
  }
  static void head() {
    static const bool once = [] {
      std::printf("| %-34s | %-34s |  n |    p50 |    p95 |    max | limit |\n", "fault",
                  "measured, ms");
      return true;
    }();
    (void)once;
  }

 private:
  static constexpr std::int64_t just_before_ns = 20'000'000;

  std::int64_t due_ns(std::int64_t from_ns) const {
    return from_ns + std::int64_t(1e6 * (limit_ms_ + scheduling_ms));
  }
  int counted() const { return int(ms_.size()) + missed_; }
  double at(double share) const {
    if (ms_.empty()) return 0;
    return ms_[std::size_t(share * double(ms_.size() - 1) + 0.5)];
  }
  std::string fault_, what_;
  double limit_ms_;
  std::map<std::string, bool> also_;  ///< whether it held at least once
  std::vector<double> ms_;
  int missed_ = 0, discarded_ = 0;
  bool detected_ = false;
  tests::Stalls& stalls_ = tests::Stalls::watch();
};

}  // namespace faults
