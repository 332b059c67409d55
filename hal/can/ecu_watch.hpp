#pragma once
#include <array>
#include <cstdint>

#include "firmware/core/frame.h"

namespace erp {

/// Detects ECUs that no longer send; they normally send every 2 ms. Pure. An ECU that has never
/// sent a frame causes no event.
class EcuWatch {
 public:
  enum class Event { silent, lost, back };
  static constexpr std::int64_t silent_ns = 10'000'000, lost_ns = 50'000'000;  // chosen

  void received(int ecu, std::int64_t now_ns) {
    auto& watched = ecus_[static_cast<std::size_t>(ecu)];
    watched.has_sent = true;
    watched.last_ns = now_ns;
  }

  /// Calls `on_event(ecu, event)` for each change since the last call.
  template <class OnEvent>
  void step(std::int64_t now_ns, OnEvent on_event) {
    for (std::size_t ecu = 0; ecu < ecus_.size(); ++ecu) {
      Watched& watched = ecus_[ecu];
      const std::int64_t silence_ns = now_ns - watched.last_ns;
      const int level = !watched.has_sent         ? 0
                        : silence_ns >= lost_ns   ? 2
                        : silence_ns >= silent_ns ? 1
                                                  : 0;
      if (level == watched.level) continue;
      // The end of `silent` causes no event, because single frames may be delayed.
      if (level > watched.level)
        on_event(static_cast<int>(ecu), level == 2 ? Event::lost : Event::silent);
      else if (watched.level == 2) on_event(static_cast<int>(ecu), Event::back);
      watched.level = level;
    }
  }

 private:
  struct Watched {
    bool has_sent = false;
    int level = 0;  ///< 0 alive, 1 silent, 2 lost
    std::int64_t last_ns = 0;
  };
  std::array<Watched, FRAME_ECUS> ecus_{};
};

}  // namespace erp
