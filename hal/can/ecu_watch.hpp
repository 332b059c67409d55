#pragma once
#include <array>
#include <cstdint>

#include "firmware/core/frame.h"

namespace erp {

/// Detects ECUs that no longer send; they normally send every 2 ms. Pure. An ECU that has never been
/// received causes no event.
class EcuWatch {
 public:
  enum class Event { silent, lost, back };
  static constexpr std::int64_t silent_ns = 10'000'000, lost_ns = 50'000'000;

  void received(int ecu, std::int64_t now_ns) {
    auto& one = ecus_[static_cast<std::size_t>(ecu)];
    one.known = true;
    one.last_ns = now_ns;
  }

  /// Calls `on_event(ecu, event)` for each change since the last call.
  template <class OnEvent>
  void step(std::int64_t now_ns, OnEvent on_event) {
    for (std::size_t ecu = 0; ecu < ecus_.size(); ++ecu) {
      One& one = ecus_[ecu];
      const std::int64_t for_ns = now_ns - one.last_ns;
      const int level = !one.known ? 0 : for_ns >= lost_ns ? 2 : for_ns >= silent_ns ? 1 : 0;
      if (level == one.level) continue;
      // The end of `silent` is not an event, only the end of `lost`: single frames may be late.
      if (level > one.level)
        on_event(static_cast<int>(ecu), level == 2 ? Event::lost : Event::silent);
      else if (one.level == 2) on_event(static_cast<int>(ecu), Event::back);
      one.level = level;
    }
  }

 private:
  struct One {
    bool known = false;
    int level = 0;  ///< 0 alive, 1 silent, 2 lost
    std::int64_t last_ns = 0;
  };
  std::array<One, FRAME_ECUS> ecus_{};
};

}  // namespace erp
