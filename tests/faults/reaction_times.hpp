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

/// Number of injections of each fault: ERP_INJECTIONS, or 20.
inline int injections() {
  const char* text = std::getenv("ERP_INJECTIONS");
  return text ? std::atoi(text) : 20;
}

/// Reaction times to a fault, one per injection: a row of the result table.
class ReactionTimes {
 public:
  static constexpr double scheduling_ms = 10;  ///< delay that a busy machine may add; chosen
  /// Total stall of the machine that makes an injection invalid. Half of `scheduling_ms`; chosen.
  static constexpr double stall_ms = 5;

  ReactionTimes(std::string fault, std::string reaction, double limit_ms)
      : fault_(std::move(fault)), reaction_(std::move(reaction)), limit_ms_(limit_ms) {}

  /// True until `needed` injections are valid, or ten times as many were made.
  bool needs_more(int needed = injections()) const {
    return valid_count() < needed && valid_count() + discarded_ < 10 * needed;
  }
  /// Adds an injection: its time, and the time of the reaction (0: none). An injection without a
  /// reaction within the limit is discarded if the machine stalled.
  void add(std::int64_t from_ns, std::int64_t to_ns) {
    const double duration_ms = 1e-6 * double(to_ns - from_ns);
    const bool has_no_reaction = to_ns == 0,
               exceeds_limit = has_no_reaction || duration_ms > limit_ms_;
    detected_ = detected_ || !has_no_reaction;
    if (exceeds_limit && !machine_kept_time(from_ns, has_no_reaction ? due_ns(from_ns) : to_ns))
      return discard();
    if (has_no_reaction) ++missed_;
    else ms_.push_back(duration_ms);
  }
  /// Discards an injection that cannot be evaluated.
  void discard() { ++discarded_; }
  /// A further condition on an injection. A violation counts only if the machine did not stall and
  /// `is_conclusive` is true.
  void require(const std::string& requirement, std::int64_t from_ns, bool is_satisfied,
               bool is_conclusive = true) {
    INFO(fault_ << ": " << requirement);
    requirements_[requirement] |= is_satisfied;
    if (is_conclusive && is_valid(from_ns)) CHECK(is_satisfied);
  }
  /// True if the machine did not stall during an injection.
  bool is_valid(std::int64_t from_ns) const { return machine_kept_time(from_ns, due_ns(from_ns)); }
  /// True if the machine did not stall in that time and in the 20 ms before.
  bool machine_kept_time(std::int64_t from_ns, std::int64_t to_ns) const {
    return stalls_.sum_of_stalls_ms(from_ns - before_ns, to_ns) < stall_ms;
  }
  /// Prints and checks the row: no injection undetected, all within the limit plus `scheduling_ms`,
  /// and of twenty injections half within the limit. If all injections were discarded, the row is
  /// not evaluated; if no injection had the expected effect, it fails.
  void check() {
    std::ranges::sort(ms_);
    std::printf("| %-34s | %-34s | %2zu | %6.1f | %6.1f | %6.1f | %5.0f |\n", fault_.c_str(),
                reaction_.c_str(), ms_.size(), percentile_ms(0.5), percentile_ms(0.95),
                percentile_ms(1), limit_ms_);
    if (discarded_)
      std::printf(
          "  (%d injections discarded: no reaction within the limit while the machine stalled)\n",
          discarded_);
    std::fflush(stdout);
    INFO(fault_ << ": " << reaction_);
    for (const auto& [requirement, satisfied] : requirements_) {
      INFO(requirement);
      CHECK(satisfied);
    }
    CHECK(detected_);
    if (valid_count() == 0 && discarded_ > 0)
      return tests::not_evaluated(fault_ + ": " + reaction_);
    CHECK(valid_count() > 0);
    CHECK(missed_ == 0);
    CHECK((ms_.size() < 20 || percentile_ms(0.5) <= limit_ms_));
    CHECK(percentile_ms(1) <= limit_ms_ + scheduling_ms);
  }
  static void print_header() {
    static const bool once = [] {
      std::printf("| %-34s | %-34s |  n |    p50 |    p95 |    max | limit |\n", "fault",
                  "measured, ms");
      return true;
    }();
    (void)once;
  }

 private:
  static constexpr std::int64_t before_ns = 20'000'000;

  std::int64_t due_ns(std::int64_t from_ns) const {
    return from_ns + std::int64_t(1e6 * (limit_ms_ + scheduling_ms));
  }
  int valid_count() const { return int(ms_.size()) + missed_; }
  double percentile_ms(double quantile) const {
    if (ms_.empty()) return 0;
    return ms_[std::size_t(quantile * double(ms_.size() - 1) + 0.5)];
  }
  std::string fault_, reaction_;
  double limit_ms_;
  std::map<std::string, bool> requirements_;  ///< true: was satisfied at least once
  std::vector<double> ms_;
  int missed_ = 0, discarded_ = 0;
  bool detected_ = false;
  tests::Stalls& stalls_ = tests::Stalls::watch();
};

}  // namespace faults
