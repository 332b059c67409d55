#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "interfaces/values.hpp"

/// Selects the owner of one actuator: of the controllers whose last command is not stale, the one
/// with the highest priority; among equal priorities, the current owner.
namespace plant {

/// The last command of one controller for one actuator.
struct ControllerCommand {
  char controller[33] = "";
  std::int32_t priority = 0;
  erp::Mode mode = erp::Mode::off;
  double reference = 0;
  std::int64_t received_ns = 0;
};

class Arbiter {
 public:
  static constexpr std::size_t max_controllers = 8;  // chosen

  /// Stores the command of a controller. False if `max_controllers` other commands are not stale.
  bool update(std::string_view controller, std::int32_t priority, erp::Mode mode, double reference,
              std::int64_t now_ns, std::int64_t stale_ns);
  /// Selects the owner and returns its command; nullptr when all commands are stale.
  const ControllerCommand* winner(std::int64_t now_ns, std::int64_t stale_ns);
  std::string_view owner() const { return owner_ < 0 ? "" : commands_[slot(owner_)].controller; }
  /// True when another controller is the owner and has at least this priority.
  bool outranked(std::string_view controller, std::int32_t priority) const {
    return owner_ >= 0 && owner() != controller && commands_[slot(owner_)].priority >= priority;
  }

 private:
  static std::size_t slot(int index) { return static_cast<std::size_t>(index); }
  ControllerCommand* find(std::string_view controller);
  std::array<ControllerCommand, max_controllers> commands_{};
  std::size_t count_ = 0;
  int owner_ = -1;  ///< index into commands_; −1: no owner
};

}  // namespace plant
