#pragma once
#include <algorithm>
#include <cstdint>

/// When a periodic call is due. Pure.
namespace node {

/// Calls that come late are made up at twice the rate, so that who answers them can, as far as they
/// are at most `make_up_ns` late; those before are left out.
class Timer {
 public:
  Timer(std::int64_t period_ns, std::int64_t make_up_ns, std::int64_t now_ns)
      : period_ns_(period_ns), make_up_ns_(make_up_ns) {
    restart(now_ns);
  }

  void restart(std::int64_t now_ns) { due_ns_ = now_ns + period_ns_, ready_ns_ = now_ns; }
  std::int64_t next_ns() const { return std::max(due_ns_, ready_ns_); }
  /// The call of `now_ns` (≥ next_ns) is made. How many before it are left out for good.
  std::int64_t take(std::int64_t now_ns) {
    const auto too_late_ns = now_ns - due_ns_ - make_up_ns_;
    const auto left_out = std::max<std::int64_t>(0, too_late_ns / period_ns_);
    due_ns_ += (left_out + 1) * period_ns_;
    ready_ns_ = now_ns + period_ns_ / 2;
    return left_out;
  }

 private:
  std::int64_t period_ns_, make_up_ns_;
  std::int64_t due_ns_ = 0;    ///< by the clock
  std::int64_t ready_ns_ = 0;  ///< not before
};

}  // namespace node
