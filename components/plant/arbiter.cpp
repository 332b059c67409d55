#include "components/plant/arbiter.hpp"

#include <algorithm>

namespace plant {

std::optional<std::size_t> Arbiter::find(std::string_view controller) const {
  for (std::size_t i = 0; i < commands_.size(); ++i)
    if (commands_[i].in_use && controller == commands_[i].controller) return i;
  return std::nullopt;
}

/// A free or stale place, else the one of lowest rank if `by` has a higher one.
std::optional<std::size_t> Arbiter::replaceable(const ControllerCommand& by,
                                                std::int64_t stale_ns) const {
  std::optional<std::size_t> lowest;
  for (std::size_t i = 0; i < commands_.size(); ++i) {
    const ControllerCommand& command = commands_[i];
    if (command.is_stale(by.received_ns, stale_ns)) return i;
    const bool is_kept = owner_ == i && command.priority >= by.priority && !by.is_emergency();
    if (!is_kept && (!lowest || command.rank() < commands_[*lowest].rank())) lowest = i;
  }
  if (lowest && commands_[*lowest].rank() >= by.rank()) lowest.reset();
  return lowest;
}

bool Arbiter::update(std::string_view controller, std::int32_t priority, erp::Mode mode,
                     double reference, std::int64_t now_ns, std::int64_t stale_ns) {
  ControllerCommand command{"", priority, mode, reference, now_ns, true};
  const auto size = std::min(controller.size(), sizeof command.controller - 1);
  std::copy_n(controller.data(), size, command.controller);
  auto place = find(command.controller);
  if (place && commands_[*place].is_emergency() && !command.is_emergency()) return false;
  if (!place) {
    place = replaceable(command, stale_ns);
    if (!place) return false;
    if (place == owner_) owner_.reset();
  }
  commands_[*place] = command;
  return true;
}

void Arbiter::release(std::string_view controller, std::int32_t priority) {
  const bool releases_emergency = priority == erp::emergency_priority;
  if (owner_ && owner() == controller) released_ = true;
  for (ControllerCommand& command : commands_)
    if (command.is_emergency() ? releases_emergency : controller == command.controller)
      command.in_use = false;
}

const ControllerCommand* Arbiter::winner(std::int64_t now_ns, std::int64_t stale_ns) {
  std::optional<std::size_t> winner;
  for (std::size_t i = 0; i < commands_.size(); ++i) {
    ControllerCommand& command = commands_[i];
    if (command.is_stale(now_ns, stale_ns)) command.in_use = false;
    if (!command.in_use) continue;
    const bool is_higher = !winner || command.priority > commands_[*winner].priority ||
                           (command.is_emergency() && !commands_[*winner].is_emergency());
    const bool stays_owner = winner && owner_ == i &&
                             command.priority == commands_[*winner].priority &&
                             command.is_emergency() == commands_[*winner].is_emergency();
    if (is_higher || stays_owner) winner = i;
  }
  owner_ = winner;
  if (winner) released_ = false;
  return winner ? &commands_[*winner] : nullptr;
}

}  // namespace plant
