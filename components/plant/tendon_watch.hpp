#pragma once
#include <cstdint>

/// Whether a tendon is taut, from its tension and its line alone.
///
///   slack     below `slack_N` for 16 ms while it should pull
///   snapped   slack, and `take_up_m` of line wound since without coming taut; stays so until
///             `forget`
///
/// A slack tendon is no fault: limbs are moved by hand, followers let go. But a force law on it
/// finds nothing to stop it.
namespace plant {

enum class Tautness { taut, slack, snapped };

class TendonWatch {
 public:
  struct Params {
    double slack_N, take_up_m;
  };
  explicit TendonWatch(const Params& params) : params_(params) {}

  /// One reading. `should_pull`: it is asked for more than slack. Line falls when wound.
  Tautness see(double tension_N, double line_m, bool should_pull, std::int64_t now_ns);
  Tautness now() const { return now_; }
  /// It is not pulled any more: what was seen says nothing of later, but that it has snapped.
  void rest() {
    if (now_ != Tautness::snapped) forget();
  }
  void forget() { now_ = Tautness::taut, loose_ = false; }

  /// Of tension that fails: said within 20 ms, as readings are up to 4 ms old.
  static constexpr std::int64_t patience_ns = 16'000'000;

 private:
  Params params_;
  Tautness now_ = Tautness::taut;
  bool loose_ = false;
  std::int64_t loose_since_ns_ = 0;
  double loose_line_m_ = 0;  ///< where it came loose
};

}  // namespace plant
