#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
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
  /// or never was, is set aside if the machine stood still in the time for it, or just before.
  void add(std::int64_t from_ns, std::int64_t to_ns) {
    const auto due_ns = from_ns + std::int64_t(1e6 * (limit_ms_ + scheduling_ms));
    const auto seen_ns = to_ns ? to_ns : due_ns;
    const double took_ms = 1e-6 * double(seen_ns - from_ns);
    const bool late = to_ns == 0 || took_ms > limit_ms_;
    if (late && stalls_.together_ms(from_ns - just_before_ns, seen_ns) >= stood_still_ms)
      ++set_aside_;
    else if (to_ns == 0) ++missed_;
    else ms_.push_back(took_ms);
  }
  /// Prints the row, and checks it: none missed, all within the limit and what scheduling adds, and
  /// of twenty injections half within the limit itself. Of what was always set aside it judges nothing.
  void check() {
    std::ranges::sort(ms_);
    std::printf("| %-34s | %-34s | %2zu | %6.1f | %6.1f | %6.1f | %5.0f |\n", fault_.c_str(),
                what_.c_str(), ms_.size(), at(0.5), at(0.95), at(1), limit_ms_);
    if (set_aside_)
      std::printf("  (and %d that were late while the machine stood still)\n", set_aside_);
    std::fflush(stdout);
    INFO(fault_ << ": " << what_);
    if (counted() == 0 && set_aside_ > 0) return tests::not_judged(fault_ + ": " + what_);
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

  int counted() const { return int(ms_.size()) + missed_; }
  double at(double share) const {
    if (ms_.empty()) return 0;
    return ms_[std::size_t(share * double(ms_.size() - 1) + 0.5)];
  }
  std::string fault_, what_;
  double limit_ms_;
  std::vector<double> ms_;
  int missed_ = 0, set_aside_ = 0;
  tests::Stalls& stalls_ = tests::Stalls::watch();
};

}  // namespace faults
