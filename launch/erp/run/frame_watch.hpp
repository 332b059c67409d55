#pragma once
#include <cstdint>

namespace launch {

/// Detects that frames no longer reach the plant, although all processes run: the bus or the device
/// is disturbed. Reads no clock.
class FrameWatch {
 public:
  enum class Change { none, stopped, resumed };
  /// Chosen: eight heartbeats, so that the report follows within 1 s.
  static constexpr std::int64_t limit_ns = 800'000'000;

  /// A heartbeat of the plant; `steps`: frames since its start.
  void on_heartbeat(std::uint64_t steps, std::int64_t now_ns) {
    if (steps != steps_) steps_ = steps, advanced_ns_ = now_ns;
  }
  /// `running`: every component is active and its process alive. While it is false, nothing is
  /// detected.
  Change update(bool running, std::int64_t now_ns) {
    if (!running) {
      advanced_ns_ = now_ns, stopped_ = false;
      return Change::none;
    }
    const bool stopped = now_ns - advanced_ns_ > limit_ns;
    if (stopped == stopped_) return Change::none;
    if (stopped) since_ns_ = advanced_ns_;
    stopped_ = stopped;
    return stopped ? Change::stopped : Change::resumed;
  }
  bool is_stopped() const { return stopped_; }
  /// Time without frames of the last interruption, until `now_ns`.
  double stopped_s(std::int64_t now_ns) const {
    return 1e-9 * static_cast<double>(now_ns - since_ns_);
  }

 private:
  std::uint64_t steps_ = 0;
  std::int64_t advanced_ns_ = 0, since_ns_ = 0;
  bool stopped_ = false;
};

}  // namespace launch
