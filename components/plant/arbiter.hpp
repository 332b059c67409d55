#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "interfaces/values.hpp"

/// Who drives one actuator: among the controllers whose last command is fresh, the one of highest
/// priority; between equals, whoever drives already.
namespace plant {

/// One controller's standing command for one actuator.
struct Offer {
  char controller[33] = "";
  std::int32_t priority = 0;
  erp::Mode mode = erp::Mode::off;
  double reference = 0;
  std::int64_t received_ns = 0;
};

class Arbiter {
 public:
  static constexpr std::size_t max_controllers = 8;  // chosen

  /// Takes or renews a controller's command. False: more than `max_controllers` are fresh.
  bool offer(std::string_view controller, std::int32_t priority, erp::Mode mode, double reference,
             std::int64_t now_ns, std::int64_t stale_ns);
  /// The driving command, or nullptr when all are stale. Remembers the driver.
  const Offer* winner(std::int64_t now_ns, std::int64_t stale_ns);
  std::string_view owner() const { return owner_ < 0 ? "" : offers_[slot(owner_)].controller; }
  /// True when another controller drives that this one cannot displace.
  bool outranked(std::string_view controller, std::int32_t priority) const {
    return owner_ >= 0 && owner() != controller && offers_[slot(owner_)].priority >= priority;
  }

 private:
  static std::size_t slot(int index) { return static_cast<std::size_t>(index); }
  Offer* find(std::string_view controller);
  std::array<Offer, max_controllers> offers_{};
  std::size_t count_ = 0;
  int owner_ = -1;  ///< index into offers_; −1: nobody
};

}  // namespace plant
