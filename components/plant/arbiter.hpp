#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <tuple>

#include "interfaces/emergency.hpp"
#include "interfaces/values.hpp"

/// Selects the owner of one actuator: an emergency off, otherwise of the controllers whose last
/// command is not stale the one with the highest priority; among equal priorities, the current owner.
namespace plant {

/// The last command of one controller for one actuator.
struct ControllerCommand {
  char controller[33] = "";
  std::int32_t priority = 0;
  erp::Mode mode = erp::Mode::off;
  double reference = 0;
  std::int64_t received_ns = 0;
  bool in_use = false;

  /// An emergency off is latched: it never becomes stale.
  bool is_emergency() const {
    return in_use && priority == erp::emergency_priority && mode == erp::Mode::off;
  }
  /// A command with a later time than now is stale: simulated time has restarted.
  bool is_stale(std::int64_t now_ns, std::int64_t stale_ns) const {
    return !is_emergency() && (!in_use || received_ns > now_ns || now_ns - received_ns > stale_ns);
  }
  /// Order in which commands keep their place in a full table.
  auto rank() const { return std::tuple(priority, mode == erp::Mode::off); }
};

class Arbiter {
 public:
  static constexpr std::size_t max_controllers = 8;  // chosen

  /// Stores the command of a controller. If the table is full, the new command replaces the one of
  /// lowest priority. Its priority must be higher, or equal with mode off while the stored mode is
  /// not off. Only a higher priority replaces the owner's command. False if the command was not
  /// stored: the table is full, or the controller has latched an emergency off.
  bool update(std::string_view controller, std::int32_t priority, erp::Mode mode, double reference,
              std::int64_t now_ns, std::int64_t stale_ns);
  /// Removes the command of a controller, unless it is an emergency off. With the emergency priority,
  /// removes every emergency off.
  void release(std::string_view controller, std::int32_t priority);
  /// Forgets all stale commands, selects the owner and returns its command; nullptr if there is
  /// none.
  const ControllerCommand* winner(std::int64_t now_ns, std::int64_t stale_ns);
  /// True if the last winner is an emergency off.
  bool is_emergency_off() const { return owner_ && commands_[*owner_].is_emergency(); }
  /// True if the last owner has released the actuator, rather than become stale.
  bool is_released() const { return released_; }
  std::string_view owner() const { return owner_ ? commands_[*owner_].controller : ""; }
  /// True when another controller is the owner and has at least this priority.
  bool outranked(std::string_view controller, std::int32_t priority) const {
    return owner_ && owner() != controller && commands_[*owner_].priority >= priority;
  }

 private:
  std::optional<std::size_t> find(std::string_view controller) const;
  std::optional<std::size_t> replaceable(const ControllerCommand& by, std::int64_t stale_ns) const;
  std::array<ControllerCommand, max_controllers> commands_{};
  std::optional<std::size_t> owner_;  ///< index into commands_
  bool released_ = false;
};

}  // namespace plant
