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
  const char* wanted = std::getenv("ERP_INJECTIONS");
  return wanted ? std::atoi(wanted) : 20;
}

/// What one row of the table measured, injection by injection.
class Row {
 public:
  static constexpr double scheduling_ms = 10;  ///< what a busy machine may add to a wake-up; chosen
  /// The machine, all in all: an injection says nothing then. Half of what scheduling may add; chosen.
  static constexpr double stood_still_ms = 5;

  Row(std::string fault, std::string what, double limit_ms)
      : fault_(std::move(fault)), what_(std::move(what)), limit_ms_(limit_ms) {}

  /// Whether there are to be more injections: of those that count, `wanted`; ten times as many at most.
  bool wants(int wanted = injections()) const {
    return counted() < wanted && counted() + set_aside_ < 10 * wanted;
  }
  /// One injection: when it was done, and when that was noticed or safe (0: never). One that is late,
  /// or never was, is set aside if the machine did not keep time.
  void add(std::int64_t from_ns, std::int64_t to_ns) {
    const double took_ms = 1e-6 * double(to_ns - from_ns);
    const bool never = to_ns == 0, late = never || took_ms > limit_ms_;
    noticed_ = noticed_ || !never;
    if (late && !kept_time(from_ns, never ? due_ns(from_ns) : to_ns)) return set_aside();
    if (never) ++missed_;
    else ms_.push_back(took_ms);
  }
  /// One of which nothing can be said.
  void set_aside() { ++set_aside_; }
  /// What else must hold of an injection. Where it does not, the machine must have kept time while that
  /// was due, and `may_judge` be true, for it to count.
  void also(const std::string& what, std::int64_t from_ns, bool holds, bool may_judge = true) {
    INFO(fault_ << ": " << what);
    also_[what] |= holds;
    if (may_judge && judges(from_ns)) CHECK(holds);
  }
  /// Whether the machine kept time while an injection was due.
  bool judges(std::int64_t from_ns) const { return kept_time(from_ns, due_ns(from_ns)); }
  /// Whether the machine stood still neither in that time nor just before.
  bool kept_time(std::int64_t from_ns, std::int64_t to_ns) const {
    return stalls_.together_ms(from_ns - just_before_ns, to_ns) < stood_still_ms;
  }
  /// Prints the row, and checks it: none missed, all within the limit and what scheduling adds, and
  /// of twenty injections half within the limit itself. What was always set aside is not judged; but
  /// what was not so a single time has failed, however the machine was.
  void check() {
    std::ranges::sort(ms_);
    std::printf("| %-34s | %-34s | %2zu | %6.1f | %6.1f | %6.1f | %5.0f |\n", fault_.c_str(),
                what_.c_str(), ms_.size(), at(0.5), at(0.95), at(1), limit_ms_);
    if (set_aside_)
      std::printf("  (and %d that were late while the machine stood still)\n", set_aside_);
    std::fflush(stdout);
    INFO(fault_ << ": " << what_);
    for (const auto& [what, held] : also_) {
      INFO(what);
      CHECK(held);
    }
    CHECK(noticed_);
    if (counted() == 0 && set_aside_ > 0) return tests::not_evaluated(fault_ + ": " + what_);
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
  std::map<std::string, bool> also_;  ///< whether it held a single time
  std::vector<double> ms_;
  int missed_ = 0, set_aside_ = 0;
  bool noticed_ = false;
  tests::Stalls& stalls_ = tests::Stalls::watch();
};

}  // namespace faults
