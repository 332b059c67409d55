#pragma once
#include <array>
#include <cstdint>

#include "firmware/core/frame.h"

namespace erp {

/// Which ECUs have fallen silent: they speak every 2 ms. Pure; of those never heard it says
/// nothing.
class EcuWatch {
 public:
  enum class News { silent, lost, back };
  static constexpr std::int64_t silent_ns = 10'000'000, lost_ns = 50'000'000;

  void heard(int ecu, std::int64_t now_ns) {
    auto& one = ecus_[static_cast<std::size_t>(ecu)];
    one.known = true;
    one.last_ns = now_ns;
  }

  /// Calls `say(ecu, news)` for each change since the last call.
  template <class Say>
  void step(std::int64_t now_ns, Say say) {
    for (std::size_t ecu = 0; ecu < ecus_.size(); ++ecu) {
      One& one = ecus_[ecu];
      const std::int64_t for_ns = now_ns - one.last_ns;
      const int level = !one.known ? 0 : for_ns >= lost_ns ? 2 : for_ns >= silent_ns ? 1 : 0;
      if (level == one.level) continue;
      // From silent to well again is said only if it was lost: a frame or two may be late.
      if (level > one.level) say(static_cast<int>(ecu), level == 2 ? News::lost : News::silent);
      else if (one.level == 2) say(static_cast<int>(ecu), News::back);
      one.level = level;
    }
  }

 private:
  struct One {
    bool known = false;
    int level = 0;  ///< 0 well, 1 silent, 2 lost
    std::int64_t last_ns = 0;
  };
  std::array<One, FRAME_ECUS> ecus_{};
};

}  // namespace erp
